/*
 * Sends each frame when it is due and the board has room for it, and reads the replies only as far as needed for that.
 * Frames and records: docs/navigation-link.md.
 */
#include "simrun_frames.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

#include "simrun_mcu.h"
#include "simrun_output.h"
#include "simrun_times.h"

#define DUE_MAX_US 1e12

enum {
    FRAME_BYTES_MAX = 127, /* the board's window: a longer frame would wait for ever */
    ANSWER_MAX = 254,
    LINE_CHARACTERS = 1024,
    SILENT_MS = 2000
};

/* the board's records: the greeting with its window, the reply with the bytes it has taken */
enum { HELLO = 'h', HELLO_WINDOW = 3, ANSWER = 'k', ANSWER_TAKEN = 5, NUMBER_BYTES = 2 };

typedef struct {
    double due_us; /* from the greeting on */
    size_t at;     /* of its bytes */
    unsigned length;
} frame_t;

static const char *file_path;
static frame_t *frames;
static uint8_t *bytes;
static size_t frame_count, byte_count;
static size_t next_frame;
static unsigned next_byte;
static size_t answered;
static uint64_t greeted_at = NEVER; /* cycle */
static unsigned window;
static uint16_t sent, taken;
static uint64_t last_answer;
static uint64_t over_at = NEVER;
static double latest_us;
static bool timed; /* the first frame with a time of its own has been sent */

static uint8_t answer[ANSWER_MAX];
static unsigned answer_length, run;
static bool behind_zero = true, too_long;

static void refuse(unsigned line, const char *reason) __attribute__((noreturn));
static void refuse(unsigned line, const char *reason)
{
    output_refuse("%s:%u: %s", file_path, line, reason);
}

static void *grown(void *memory, size_t count, size_t size)
{
    void *more = realloc(memory, count * size);
    if (more == NULL) {
        fputs("simrun: out of memory\n", stderr);
        exit(EXIT_INTERNAL);
    }
    return more;
}

static int digit(char character)
{
    const char *digits = "0123456789abcdef";
    const char *found = character == '\0' ? NULL : strchr(digits, tolower((unsigned char)character));
    return found == NULL ? -1 : (int)(found - digits);
}

/* Appends the bytes of pairs of digits up to the end of the line; returns how many. */
static unsigned take_bytes(const char *at, unsigned line)
{
    unsigned length = 0;
    bool any = false;
    for (; !isspace((unsigned char)*at) && *at != '\0'; at += 2) {
        int high = digit(at[0]);
        int low = high < 0 ? -1 : digit(at[1]);
        if (low < 0) {
            refuse(line, "a frame is bytes of two hexadecimal digits each");
        }
        if (length == FRAME_BYTES_MAX) {
            refuse(line, "a frame has 1 to 127 bytes: the board has no room for more");
        }
        bytes[byte_count + length++] = (uint8_t)(high * 16 + low);
        any = any || high + low != 0;
    }
    if (length == 0) {
        refuse(line, "no bytes");
    }
    if (!any) {
        refuse(line, "an empty frame: the board does not answer zero bytes alone");
    }
    return length;
}

/* "DUE_US HEX": appends the frame. */
static void take_line(const char *text, unsigned line)
{
    char *at;
    frame_t frame = { .due_us = strtod(text, &at), .at = byte_count };
    if (at == text || *at != ' ' || !(frame.due_us >= 0.0 && frame.due_us <= DUE_MAX_US)) {
        refuse(line, "a frame is 'DUE_US HEX'");
    }
    if (frame_count != 0 && frame.due_us < frames[frame_count - 1].due_us) {
        refuse(line, "due before the frame ahead of it");
    }
    frame.length = take_bytes(at + 1, line);
    byte_count += frame.length;
    frames[frame_count++] = frame;
}

static void make_room(void)
{
    static size_t frame_room;
    static size_t byte_room;
    if (frame_count == frame_room) {
        frame_room = 2 * frame_room + 1024;
        frames = grown(frames, frame_room, sizeof *frames);
    }
    if (byte_count + FRAME_BYTES_MAX > byte_room) {
        byte_room = 2 * byte_room + 65536;
        bytes = grown(bytes, byte_room, 1);
    }
}

void frames_start(const char *path)
{
    char text[LINE_CHARACTERS];
    if (path == NULL) {
        return;
    }
    file_path = path;
    FILE *file = fopen(path, "r");
    if (file == NULL) {
        perror(path);
        exit(EXIT_INPUT);
    }
    for (unsigned line = 1; fgets(text, sizeof text, file) != NULL; line++) {
        if (strchr(text, '\n') == NULL && !feof(file)) {
            refuse(line, "the line is too long");
        }
        if (text[0] != '#') {
            make_room();
            take_line(text, line);
        }
    }
    (void)fclose(file);
    if (frame_count == 0) {
        refuse(1, "no frame");
    }
}

bool frames_wanted(void)
{
    return frame_count != 0;
}

static unsigned number_at(unsigned at)
{
    return answer[at] | (unsigned)answer[at + 1] << 8;
}

static void on_record(void)
{
    if (answer[0] == HELLO && answer_length >= HELLO_WINDOW + NUMBER_BYTES) {
        window = number_at(HELLO_WINDOW);
        sent = 0; /* a board that restarts has no record of anything */
        taken = 0;
        if (greeted_at == NEVER) {
            greeted_at = mcu->cycle;
        }
    } else if (answer[0] == ANSWER && answer_length >= ANSWER_TAKEN + NUMBER_BYTES) {
        taken = (uint16_t)number_at(ANSWER_TAKEN);
        if ((int16_t)(sent - taken) < 0) { /* a frame was in flight when the board restarted */
            sent = taken;
        }
        answered++;
        if (next_frame == frame_count && taken == sent) { /* a damaged frame may have had two replies */
            over_at = mcu->cycle;
            times_streaming_ends();
        }
    }
    last_answer = mcu->cycle;
}

static void keep(uint8_t byte)
{
    if (answer_length == ANSWER_MAX) {
        too_long = true;
    } else {
        answer[answer_length++] = byte;
    }
}

/* The board's records: zero ends one, other bytes are stuffed (no run here has 254 bytes). */
bool frames_take(uint8_t byte)
{
    if (byte == 0) {
        if (answer_length != 0 && run == 0 && !too_long) {
            on_record();
        }
        answer_length = 0;
        run = 0;
        behind_zero = true;
        too_long = false;
        return true;
    }
    if (run != 0) {
        run--;
        keep(byte);
        return false;
    }
    if (!behind_zero) {
        keep(0);
    }
    behind_zero = false;
    run = byte - 1u;
    return false;
}

static uint64_t due_cycle(void)
{
    return greeted_at + (uint64_t)(frames[next_frame].due_us * CYCLES_PER_US);
}

static void begin_frame(void)
{
    if (frames[next_frame].due_us > 0.0 && !timed) {
        timed = true;
        times_streaming_begins();
    }
    double late_us = (double)(mcu->cycle - due_cycle()) / CYCLES_PER_US;
    latest_us = late_us > latest_us ? late_us : latest_us;
}

bool frames_next_byte(uint8_t *byte, uint64_t *look_again)
{
    *look_again = NEVER;
    if (greeted_at == NEVER || next_frame == frame_count) {
        return false;
    }
    const frame_t *frame = &frames[next_frame];
    if (next_byte == 0) {
        if (mcu->cycle < due_cycle()) {
            *look_again = due_cycle();
            return false;
        }
        if ((uint16_t)(sent - taken) + frame->length > window) {
            return false; /* the next reply makes room */
        }
        begin_frame();
        sent = (uint16_t)(sent + frame->length);
    }
    *byte = bytes[frame->at + next_byte++];
    if (next_byte == frame->length) {
        next_byte = 0;
        next_frame++;
    }
    return true;
}

uint64_t frames_over_at(void)
{
    return over_at;
}

bool frames_silent(void)
{
    uint64_t since = next_frame < frame_count && greeted_at != NEVER ? due_cycle() : 0;
    since = since > last_answer ? since : last_answer;
    return over_at == NEVER && mcu->cycle > since + (uint64_t)SILENT_MS * CYCLES_PER_MS;
}

void frames_print(FILE *json)
{
    if (frames_wanted()) {
        fprintf(json, "  \"frames_sent\": %zu,\n  \"frames_answered\": %zu,\n  \"frames_latest_us\": %.1f,\n",
                next_frame, answered, latest_us);
    }
}
