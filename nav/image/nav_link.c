/* One record in, its reply out. */
#include "nav_link.h"

#include <stddef.h>

#include "hal_time.h"
#include "hal_watchdog.h"
#include "machine.h"
#include "nav_frame.h"

enum {
    HEAD = 2,        /* type and sequence number of a record */
    TIME = 4,        /* bytes of t_us */
    REAL = 4,        /* bytes of a real */
    PARAMETERS = 30, /* reals of nav_config_t */
    PARAMETERS_AT_ONCE = 6,
    ALL_PARAMETERS = 0x1F, /* a bit for each of the five groups */
    STATE_REALS = 13,
    STATE_BYTES = 1 + TIME + STATE_REALS * REAL,
    VARIANCES_BYTES = 2 + NAV_STATES * REAL,
    ANSWER_BYTES = 7,
    HELLO_BYTES = 6,
    ROOM = STATE_BYTES + FRAME_OVERHEAD + ANSWER_BYTES + FRAME_OVERHEAD, /* the longest output that one record causes */
    ROOM_US = 200,                                                       /* 20 bytes are sent */
    LINK_ANSWERS = LINK_ANSWERS_END - LINK_BROKEN,
    SEQUENCES_AHEAD = 0x80 /* a number less than this before the expected one has already been received */
};

_Static_assert(sizeof(nav_state_t) == STATE_REALS * REAL, "a state is sent as it lies in memory");
_Static_assert(offsetof(nav_config_t, period_us) == PARAMETERS * REAL, "the parameters are the reals of nav_config_t");

/* The parameters are stored where the filter will be: RAM has no room for a second copy. */
static union {
    nav_t nav;
    nav_config_t config;
} filter;
static frame_reader_t reader;
static uint16_t taken;
static uint16_t refused[LINK_ANSWERS];
static uint16_t missing; /* numbers that never arrived */
static uint8_t expected;
static bool any_number;    /* the next record's number is not checked */
static uint8_t parameters; /* a bit for each group received */
static bool started;

static void put_u16(uint8_t *to, uint16_t value)
{
    to[0] = (uint8_t)value;
    to[1] = (uint8_t)(value >> 8);
}

static uint16_t get_u16(const uint8_t *from)
{
    return (uint16_t)(from[0] | (uint16_t)((uint16_t)from[1] << 8));
}

static uint32_t get_u32(const uint8_t *from)
{
    return get_u16(from) | (uint32_t)get_u16(from + 2) << 16;
}

/* Reals have the same layout in memory as on the line, but need not be aligned there. */
static void copy(void *to, const void *from, uint8_t length)
{
    uint8_t *destination = to;
    const uint8_t *source = from;
    while (length-- != 0) {
        *destination++ = *source++;
    }
}

static uint16_t one_more(uint16_t count)
{
    return count == UINT16_MAX ? count : (uint16_t)(count + 1u);
}

MACHINE_APART static void send_hello(void)
{
    uint8_t frame[HELLO_BYTES + FRAME_OVERHEAD] = { 0, ANSWER_HELLO, LINK_VERSION, NAV_STATES };
    put_u16(&frame[4], LINK_WINDOW);
    frame[6] = (uint8_t)hal_reset_cause();
    frame_send(frame, HELLO_BYTES);
}

MACHINE_APART static void send_state(uint32_t t_us)
{
    uint8_t frame[STATE_BYTES + FRAME_OVERHEAD];
    uint8_t *record = &frame[1];
    record[0] = ANSWER_STATE;
    put_u16(&record[1], (uint16_t)t_us);
    put_u16(&record[3], (uint16_t)(t_us >> 16));
    copy(&record[1 + TIME], nav_state(&filter.nav), STATE_REALS * REAL);
    frame_send(frame, STATE_BYTES);
}

MACHINE_APART static void send_variances(void)
{
    uint8_t frame[VARIANCES_BYTES + FRAME_OVERHEAD] = { 0, ANSWER_VARIANCES, nav_healthy(&filter.nav) };
    nav_real_t variance[NAV_STATES];
    nav_variances(&filter.nav, variance);
    copy(&frame[3], variance, sizeof variance);
    frame_send(frame, VARIANCES_BYTES);
}

MACHINE_APART static void send_counts(void)
{
    uint8_t frame[1 + sizeof(uint16_t[NAV_ANSWERS + LINK_ANSWERS + 1]) + FRAME_OVERHEAD];
    uint8_t *record = &frame[1];
    const nav_counts_t *counts = nav_counts(&filter.nav);
    record[0] = ANSWER_COUNTS;
    uint8_t at = 1;
    for (uint8_t i = 0; i < NAV_ANSWERS; i++, at = (uint8_t)(at + 2u)) {
        put_u16(&record[at], counts->answer[i]);
    }
    for (uint8_t i = 0; i < LINK_ANSWERS; i++, at = (uint8_t)(at + 2u)) {
        put_u16(&record[at], refused[i]);
    }
    put_u16(&record[at], missing);
    frame_send(frame, (uint8_t)(at + 2u));
}

static uint8_t on_parameters(const uint8_t *body)
{
    uint8_t first = body[0];
    if (first >= PARAMETERS || first % PARAMETERS_AT_ONCE != 0) {
        return LINK_START_REFUSED;
    }
    if (started) {
        started = false;
        parameters = 0;
    }
    copy((nav_real_t *)&filter.config + first, &body[1], sizeof(nav_real_t[PARAMETERS_AT_ONCE]));
    parameters = (uint8_t)(parameters | 1u << (first / PARAMETERS_AT_ONCE));
    return NAV_TAKEN;
}

MACHINE_APART static uint8_t on_start(const uint8_t *body)
{
    if (started || parameters != ALL_PARAMETERS) {
        return LINK_START_REFUSED;
    }
    nav_config_t config = filter.config;
    config.period_us = get_u32(body);
    started = nav_init(&filter.nav, &config);
    parameters = 0;
    missing = 0;
    for (uint8_t i = 0; i < LINK_ANSWERS; i++) {
        refused[i] = 0;
    }
    return started ? NAV_TAKEN : LINK_START_REFUSED;
}

MACHINE_APART static uint8_t on_imu(const uint8_t *body)
{
    nav_real_t measured[6];
    uint32_t t_us = get_u32(body);
    copy(measured, &body[TIME], sizeof measured);
    uint8_t answer = (uint8_t)nav_imu(&filter.nav, t_us, measured, &measured[3]);
    if (body[TIME + 6 * REAL] == 1u) {
        send_state(filter.nav.t_us); /* a refused record's time is not that of the state */
    }
    return answer;
}

MACHINE_APART static uint8_t on_gps(const uint8_t *body)
{
    nav_real_t measured[6];
    copy(measured, &body[TIME], sizeof measured);
    return (uint8_t)nav_gps(&filter.nav, get_u32(body), measured, &measured[3]);
}

static uint8_t on_down(const uint8_t *body)
{
    nav_real_t down_m;
    copy(&down_m, &body[TIME], sizeof down_m);
    return (uint8_t)nav_down(&filter.nav, get_u32(body), down_m);
}

static uint8_t on_field(const uint8_t *body)
{
    nav_real_t field[3];
    copy(field, &body[TIME], sizeof field);
    return (uint8_t)nav_field(&filter.nav, get_u32(body), field);
}

/* Bytes after the head of a record of this type; UINT8_MAX: no such type. */
static uint8_t length_of(uint8_t type)
{
    switch (type) {
    case RECORD_PARAMETERS:
        return 1 + PARAMETERS_AT_ONCE * REAL;
    case RECORD_START:
        return 4;
    case RECORD_IMU:
        return TIME + 6 * REAL + 1;
    case RECORD_GPS:
        return TIME + 6 * REAL;
    case RECORD_DOWN:
        return TIME + REAL;
    case RECORD_FIELD:
        return TIME + 3 * REAL;
    case RECORD_VARIANCES:
    case RECORD_COUNTS:
    case RECORD_HELLO:
        return 0;
    default:
        return UINT8_MAX;
    }
}

static uint8_t carry_out(uint8_t type, const uint8_t *body)
{
    switch (type) {
    case RECORD_PARAMETERS:
        return on_parameters(body);
    case RECORD_START:
        return on_start(body);
    case RECORD_IMU:
        return on_imu(body);
    case RECORD_GPS:
        return on_gps(body);
    case RECORD_DOWN:
        return on_down(body);
    case RECORD_FIELD:
        return on_field(body);
    case RECORD_VARIANCES:
        send_variances();
        return NAV_TAKEN;
    default:
        send_counts();
        return NAV_TAKEN;
    }
}

/* An earlier number is refused; a later one means that those in between are missing. */
static bool in_order(uint8_t sequence)
{
    uint8_t ahead = (uint8_t)(sequence - expected);
    if (!any_number && ahead >= SEQUENCES_AHEAD) {
        return false;
    }
    if (!any_number) {
        missing = missing > UINT16_MAX - ahead ? UINT16_MAX : (uint16_t)(missing + ahead);
    }
    any_number = false;
    expected = (uint8_t)(sequence + 1u);
    return true;
}

static uint8_t answer_to(uint8_t type, uint8_t sequence, uint8_t length, const uint8_t *body)
{
    uint8_t wanted = length_of(type);
    if (wanted == UINT8_MAX) {
        return LINK_UNKNOWN;
    }
    if (wanted != length) {
        return LINK_LENGTH;
    }
    if (type == RECORD_HELLO) {
        send_hello();
        expected = (uint8_t)(sequence + 1u);
        any_number = true;
        return NAV_TAKEN;
    }
    if (!in_order(sequence)) {
        return LINK_ORDER;
    }
    if (!started && type != RECORD_START && type != RECORD_PARAMETERS) {
        return LINK_NOT_STARTED;
    }
    return carry_out(type, body);
}

MACHINE_APART static void send_answer(uint8_t type, uint8_t sequence, uint8_t answer)
{
    uint8_t frame[ANSWER_BYTES + FRAME_OVERHEAD] = { 0, ANSWER_RECORD, sequence, type, answer };
    frame[5] = started ? nav_queued(&filter.nav) : 0;
    put_u16(&frame[6], taken);
    frame_send(frame, ANSWER_BYTES);
}

static void on_frame(bool good)
{
    uint8_t type = 0;
    uint8_t sequence = 0;
    uint8_t answer = LINK_BROKEN;
    if (good && reader.length >= HEAD) {
        type = reader.bytes[0];
        sequence = reader.bytes[1];
        answer = answer_to(type, sequence, (uint8_t)(reader.length - HEAD), &reader.bytes[HEAD]);
    } else if (good) {
        type = reader.bytes[0];
        answer = LINK_LENGTH;
    }
    if (answer >= LINK_BROKEN) {
        refused[answer - LINK_BROKEN] = one_more(refused[answer - LINK_BROKEN]);
    }
    send_answer(type, sequence, answer);
}

void link_start(void)
{
    hal_uart_init(LINK_BAUD);
    frame_reader_init(&reader);
    taken = 0;
    parameters = 0;
    started = false;
    any_number = true;
    send_hello();
}

bool link_pass(void)
{
    uint8_t byte;
    bool any = false;
    if (hal_uart_tx_room() < ROOM) {
        hal_wake_at(hal_time_us() + ROOM_US); /* transmitted bytes do not wake main */
        return false;
    }
    while (hal_uart_rx(&byte)) {
        any = true;
        taken++;
        frame_result_t result = frame_take(&reader, byte);
        if (result != FRAME_MORE) {
            on_frame(result == FRAME_GOOD);
            break;
        }
    }
    return any;
}
