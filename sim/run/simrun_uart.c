/*
 * What the firmware sends goes to --out and is cut into lines; the commands of --rate and the like and of --cmd are
 * typed, one byte per byte time. Bytes, not bits: the PC always follows the MCU's baud rate.
 */
#include "simrun_uart.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

#include "sim_io.h"
#include "simrun_events.h"
#include "simrun_failure.h"
#include "simrun_frames.h"
#include "simrun_mcu.h"
#include "simrun_output.h"
#include "simrun_pty.h"
#include "simrun_transmitter.h"
#include "simrun_vcd.h"

enum {
    REG_UBRR0L = 0xC4,
    LINE_MAX_LENGTH = 255,
    ROW_FIELDS = 10,
    UNANSWERED_MAX = 60, /* bytes typed without a reply: the firmware's ring holds 63 */
    REPLY_TIMEOUT_MS = 500,
    AFTER_REPLY_MS = 8,
    RX_HOLDS = 3 /* two bytes and the one on the line; simavr's FIFO has 64 */
};

static avr_uart_t *uart;
static avr_irq_t *uart_input;
static FILE *out_file;
static const uart_options_t *options;
static void (*take_row)(const row_t *row);
static uint64_t last_tx;
static uint64_t byte_count;
static char line[LINE_MAX_LENGTH + 1];
static size_t line_length;
static bool banner_seen, header_seen;

static size_t next_typed; /* line of options->typed */
static size_t next_character;
static size_t unanswered; /* bytes typed since the last reply */
static bool waits_for_reply, waits_for_baud;
static uint64_t reply_deadline;
static uint64_t next_byte_at = NEVER;
static uint64_t line_free_at; /* end of the last byte of a frame */
static uint32_t rx_overruns;
static bool flooded;
static enum { SPOILT_NOTHING, SPOILT_STOP, SPOILT_LOST } spoilt; /* fault of the next byte received */

/* A row of csv mode: ten whole numbers; t_us, x_lsb, y_lsb, z_lsb first and flags last. */
static bool parse_row(row_t *row)
{
    long value[ROW_FIELDS];
    char *at = line;
    for (size_t i = 0; i < ROW_FIELDS; i++) {
        char *end;
        value[i] = strtol(at, &end, 10);
        bool last = i == ROW_FIELDS - 1;
        if (end == at || *end != (last ? '\0' : ',')) {
            return false;
        }
        at = end + 1;
    }
    *row = (row_t){ .t_us = (uint32_t)value[0], .flags = (unsigned)value[ROW_FIELDS - 1], .sent = mcu->cycle };
    for (size_t axis = 0; axis < 3; axis++) {
        row->lsb[axis] = (int16_t)value[1 + axis];
    }
    return true;
}

/* Typing resumes a little later; another reply postpones it again. */
static void on_reply(void)
{
    if (waits_for_reply) {
        reply_deadline = mcu->cycle + (uint64_t)AFTER_REPLY_MS * CYCLES_PER_MS;
        next_byte_at = reply_deadline;
        events_reschedule();
    }
}

static void begin_typing(void)
{
    banner_seen = true;
    next_byte_at = mcu->cycle;
    events_reschedule();
}

/* The firmware names the setting it refuses; if an option requested it, the run ends. */
static void on_refusal(const char *setting)
{
    for (size_t i = 0; i < options->typed_count; i++) {
        const char *text = options->typed[i].text;
        size_t length = strcspn(text, " ");
        if (options->typed[i].setting && strncmp(setting, text, length) == 0 && setting[length] == ' ') {
            static char reason[LINE_MAX_LENGTH + 64];
            snprintf(reason, sizeof reason, "--%s: the firmware refused it: %s", text, setting);
            failure_set(EXIT_INPUT, reason);
        }
    }
}

static void on_comment(void)
{
    const char *words = strncmp(line, "# refused ", 10) == 0 ? strstr(line, ": ") : NULL;
    if (words != NULL) {
        on_refusal(words + 2);
    }
    if (!banner_seen) {
        begin_typing();
    } else if (header_seen && !waits_for_baud) {
        on_reply();
    }
}

static void on_line(void)
{
    while (line_length != 0 && isspace((unsigned char)line[line_length - 1])) {
        line_length--;
    }
    line[line_length] = '\0';
    row_t row;
    if (line[0] == '#') {
        on_comment();
    } else if (strncmp(line, "t_us,", 5) == 0) {
        header_seen = true;
    } else if (isdigit((unsigned char)line[0]) && parse_row(&row)) {
        take_row(&row);
    }
    line_length = 0;
}

/* The next frame may have been waiting for this record from the board. */
static void on_frame_byte(uint8_t byte)
{
    if (frames_take(byte)) {
        next_byte_at = line_free_at > mcu->cycle ? line_free_at : mcu->cycle;
        events_reschedule();
    }
}

static void on_output(uint8_t byte)
{
    fputc(byte, out_file);
    byte_count++;
    last_tx = mcu->cycle;
    vcd_change(VCD_TX, byte);
    if (pty_is_open()) {
        pty_send(byte);
    }
    if (frames_wanted()) {
        on_frame_byte(byte);
        return;
    }
    if (byte == '\n') {
        on_line();
    } else if (line_length < LINE_MAX_LENGTH) {
        line[line_length++] = (char)byte;
    }
}

static void on_baud(avr_t *avr, avr_io_addr_t address, uint8_t value, void *param)
{
    (void)avr;
    (void)address;
    (void)value;
    (void)param;
    uart->cycles_per_byte = transmitter_byte_cycles(); /* for received bytes */
    if (waits_for_baud) {
        waits_for_baud = false;
        on_reply();
    }
}

void uart_start(const uart_options_t *wanted, void (*on_row)(const row_t *row))
{
    options = wanted;
    take_row = on_row;
    out_file = output_open(wanted->out);
    uint32_t no_console = 0;
    avr_ioctl(mcu, AVR_IOCTL_UART_SET_FLAGS('0'), &no_console);
    for (avr_io_t *io = mcu->io_port; io != NULL; io = io->next) {
        if (strcmp(io->kind, "uart") == 0) {
            uart = (avr_uart_t *)io;
        }
    }
    uart_input = avr_io_getirq(mcu, AVR_IOCTL_UART_GETIRQ('0'), UART_IRQ_INPUT);
    transmitter_start(uart, on_output);
    avr_register_io_write(mcu, REG_UBRR0L, on_baud, NULL);
}

void uart_type_at_once(void)
{
    next_byte_at = 0;
}

void uart_finish(void)
{
    output_close(out_file, options->out);
}

void uart_reset(void)
{
    line_length = 0;
    transmitter_reset();
}

void uart_spoil(bool lost)
{
    spoilt = lost ? SPOILT_LOST : SPOILT_STOP;
}

static void receive(uint8_t byte)
{
    unsigned waiting = (unsigned)(uart->input.write - uart->input.read) &
                       (sizeof uart->input.buffer / sizeof uart->input.buffer[0] - 1u);
    if (waiting >= RX_HOLDS) {
        avr_regbit_set(mcu, uart->dor);
        rx_overruns++;
        return;
    }
    vcd_change(VCD_RX, byte);
    avr_raise_irq(uart_input, spoilt == SPOILT_STOP ? byte | (uint32_t)UART_INPUT_FE : byte);
    if (spoilt == SPOILT_LOST) {
        avr_regbit_set(mcu, uart->dor);
    }
    spoilt = SPOILT_NOTHING;
}

static void end_typed_line(void)
{
    const char *text = options->typed[next_typed].text;
    next_typed++;
    next_character = 0;
    waits_for_baud = strncmp(text, "baud ", 5) == 0; /* until the MCU has set its divider */
    if (waits_for_baud || unanswered > UNANSWERED_MAX) {
        waits_for_reply = true;
        reply_deadline = mcu->cycle + (uint64_t)REPLY_TIMEOUT_MS * CYCLES_PER_MS;
    }
}

/* False if there is nothing to type; next_byte_at is then the time to check again. */
static bool next_typed_byte(uint8_t *byte)
{
    next_byte_at = NEVER;
    if (next_typed == options->typed_count) {
        return false;
    }
    const typed_line_t *typed = &options->typed[next_typed];
    uint64_t due = (uint64_t)(typed->at_ms * CYCLES_PER_MS);
    if (waits_for_reply && mcu->cycle < reply_deadline) {
        next_byte_at = reply_deadline;
        return false;
    }
    if (waits_for_reply) {
        waits_for_reply = false;
        waits_for_baud = false;
        unanswered = 0;
    }
    if (mcu->cycle < due) {
        next_byte_at = due;
        return false;
    }
    next_byte_at = mcu->cycle + transmitter_byte_cycles();
    char character = typed->text[next_character++];
    *byte = character == '\0' ? '\n' : (uint8_t)character;
    unanswered++;
    if (character == '\0') {
        end_typed_line();
    }
    return true;
}

uint64_t uart_next(void)
{
    return next_byte_at;
}

void uart_flood(bool on)
{
    flooded = on;
    next_byte_at = mcu->cycle;
    events_reschedule();
}

static void step_frames(void)
{
    uint8_t byte;
    if (frames_next_byte(&byte, &next_byte_at)) {
        line_free_at = mcu->cycle + transmitter_byte_cycles();
        next_byte_at = line_free_at;
        receive(byte);
    }
}

void uart_step(void)
{
    uint8_t byte;
    if (flooded) {
        next_byte_at = mcu->cycle + transmitter_byte_cycles();
        receive((uint8_t)mcu_random());
        return;
    }
    if (frames_wanted()) {
        step_frames();
        return;
    }
    bool any = banner_seen && next_typed_byte(&byte);
    if (!any && pty_is_open()) {
        next_byte_at = mcu->cycle + transmitter_byte_cycles();
        any = pty_receive(&byte);
        pty_pace();
    }
    if (any) {
        receive(byte);
    }
}

uint64_t uart_last_tx(void)
{
    return last_tx;
}

void uart_print(FILE *json)
{
    fprintf(json, "  \"uart_baud\": %.0f,\n", 1e6 * CYCLES_PER_US * 10.0 / (double)transmitter_frame_cycles());
    fprintf(json, "  \"uart_bytes\": %llu,\n  \"uart_rx_overruns\": %u,\n", (unsigned long long)byte_count,
            (unsigned)rx_overruns);
}
