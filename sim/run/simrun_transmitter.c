/*
 * The USART's transmitter according to the data sheet (ATmega328P, 20.6): a shift register and one buffer before it.
 * UDRE0 is low while the buffer is full; TXC0 rises when a frame ends and none follows it at once, and stays set until
 * a one is written to it; changing the divider within a frame corrupts it. simavr's transmitter has only the buffer,
 * raises TXC0 with each byte, and changes the divider at any time.
 */
#include "simrun_transmitter.h"

#include <stddef.h>

#include "sim_io.h"
#include "simrun_failure.h"
#include "simrun_mcu.h"

enum {
    REG_UCSR0A = 0xC0,
    REG_UCSR0B = 0xC1,
    REG_UBRR0L = 0xC4,
    REG_UBRR0H = 0xC5,
    REG_UDR0 = 0xC6,
    BIT_U2X = 0x02,
    BIT_TXEN = 0x08,
    BITS_PER_BYTE = 10, /* 8N1; simavr counts eleven */
    LOAD_CYCLES = 2
};

#define STALL_MAX_CYCLES (1000000ull * CYCLES_PER_MS)

static avr_uart_t *uart;
static void (*take)(uint8_t byte);
static avr_io_write_t core_control;
static void *core_param;
static uint64_t frame_ends = NEVER; /* of the byte in the shift register */
static bool waits;                  /* a byte is in the buffer */
static uint8_t waiting;
static uint64_t stalled_until;

uint64_t transmitter_byte_cycles(void)
{
    unsigned divider = (mcu->data[REG_UBRR0L] | (unsigned)mcu->data[REG_UBRR0H] << 8) + 1u;
    unsigned oversampling = (mcu->data[REG_UCSR0A] & BIT_U2X) ? 8 : 16;
    return (uint64_t)divider * oversampling * BITS_PER_BYTE;
}

uint64_t transmitter_frame_cycles(void)
{
    uint64_t held = stalled_until > mcu->cycle ? stalled_until - mcu->cycle : 0;
    return transmitter_byte_cycles() + (held < STALL_MAX_CYCLES ? held : STALL_MAX_CYCLES);
}

void transmitter_stall(uint64_t until)
{
    stalled_until = until;
}

static avr_cycle_count_t on_frame_end(avr_t *avr, avr_cycle_count_t when, void *param);

static avr_cycle_count_t on_empty(avr_t *avr, avr_cycle_count_t when, void *param)
{
    (void)when;
    (void)param;
    if (!waits) {
        avr_raise_interrupt(avr, &uart->udrc);
    }
    return 0;
}

/* This interrupt is not cleared by its own execution. */
static void buffer_taken(void)
{
    avr_clear_interrupt(mcu, &uart->udrc);
    avr_regbit_clear(mcu, uart->udrc.raised);
}

static void begin_frame(uint8_t byte, uint64_t now)
{
    take(byte);
    frame_ends = now + transmitter_frame_cycles();
    avr_cycle_timer_register(mcu, frame_ends - mcu->cycle, on_frame_end, NULL);
    avr_cycle_timer_register(mcu, LOAD_CYCLES, on_empty, NULL);
}

static avr_cycle_count_t on_frame_end(avr_t *avr, avr_cycle_count_t when, void *param)
{
    (void)param;
    frame_ends = NEVER;
    if (waits) {
        waits = false;
        begin_frame(waiting, when);
    } else {
        avr_raise_interrupt(avr, &uart->txc);
    }
    return 0;
}

static void on_data(avr_t *avr, avr_io_addr_t address, uint8_t value, void *param)
{
    (void)address;
    (void)param;
    if (!(avr->data[REG_UCSR0B] & BIT_TXEN)) {
        return;
    }
    if (waits) {
        failure_set(EXIT_UART, "a byte was written to the UART before it was ready");
    } else {
        buffer_taken();
        if (frame_ends == NEVER) {
            begin_frame(value, avr->cycle);
        } else {
            waits = true;
            waiting = value;
        }
    }
}

/* simavr considers UDRE0 high if UDRIE0 is set while it sends nothing itself. */
static void on_control(avr_t *avr, avr_io_addr_t address, uint8_t value, void *param)
{
    (void)param;
    core_control(avr, address, value, core_param);
    if (waits) {
        buffer_taken();
    }
}

static void on_divider(avr_t *avr, avr_io_addr_t address, uint8_t value, void *param)
{
    (void)avr;
    (void)address;
    (void)value;
    (void)param;
    if (frame_ends != NEVER) {
        failure_set(EXIT_UART, "the UART's divider was changed while a byte was on its way");
    }
}

void transmitter_start(avr_uart_t *of, void (*on_byte)(uint8_t byte))
{
    uart = of;
    take = on_byte;
    mcu->io[AVR_DATA_TO_IO(REG_UDR0)].w.c = on_data;
    core_control = mcu->io[AVR_DATA_TO_IO(REG_UCSR0B)].w.c;
    core_param = mcu->io[AVR_DATA_TO_IO(REG_UCSR0B)].w.param;
    mcu->io[AVR_DATA_TO_IO(REG_UCSR0B)].w.c = on_control;
    avr_register_io_write(mcu, REG_UBRR0L, on_divider, NULL);
}

void transmitter_reset(void)
{
    frame_ends = NEVER;
    waits = false;
}
