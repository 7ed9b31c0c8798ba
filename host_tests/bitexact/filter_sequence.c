#include "filter_sequence.h"

#include "crc32.h"

#define SEED 2463534242UL
#define EXTREME_CALLS 40U

enum signal {
    ALTERNATING_RAILS,
    HIGH_RAIL,
    LOW_RAIL,
    ZERO_AND_MINUS_ONE,
    SPIKES, /* single ones, both rails by turns */
    EXTREME_SIGNALS,
    ANYTHING = EXTREME_SIGNALS,
    NOISE,
    RAMP,
    RANDOM_RAILS,
    SIGNALS
};

void sequence_start(filter_sequence_t *s)
{
    uint8_t *bytes = (uint8_t *)s;
    for (size_t i = 0; i < sizeof *s; i++) {
        bytes[i] = 0;
    }
    s->random = SEED;
    s->crc = CRC32_START;
    s->extremes = true;
    s->kind = linked_kind(0);
}

/* The lowest digit of a number of mixed base. */
static uint8_t take_digit(uint32_t *number, uint8_t base)
{
    uint8_t digit = (uint8_t)(*number % base);
    *number /= base;
    return digit;
}

/* Corner number i: rate, then every parameter at its lower end, its upper end, or off. False: there are no more. */
static bool corner_config(filter_kind_t kind, uint32_t i, filter_config_t *config)
{
    *config = filter_defaults(filter_listed(kind), take_digit(&i, 2) == 0U ? FILTER_RATE_MIN_DHZ : FILTER_RATE_MAX_DHZ);
    for (uint8_t n = 0; n < parameter_count(kind); n++) {
        filter_parameter_t parameter = parameter_at(kind, n);
        uint8_t digit = take_digit(&i, parameter.zero_means_off != 0U ? 3 : 2);
        config->value[n] = (digit == 0U) ? parameter.min : (digit == 1U) ? parameter.max : 0;
    }
    return i == 0U;
}

/* The next corner that the filter accepts, with the next extreme input. False: refused without reason. */
static bool begin_extreme(filter_sequence_t *s)
{
    filter_kind_t kind = (filter_kind_t)s->kind;
    filter_config_t config;
    while (corner_config(kind, s->corner / EXTREME_SIGNALS, &config)) {
        s->signal = (uint8_t)(s->corner % EXTREME_SIGNALS);
        s->corner++;
        s->calls_end = EXTREME_CALLS;
        if (filter_init(&s->filter, filter_listed(kind), &config) == FILTER_ACCEPTED) {
            return true;
        }
        if (!law_facts(kind).joint_condition) {
            return false;
        }
        s->refused++;
    }
    s->corner = 0;
    s->kind = linked_kind((uint8_t)(s->kind + 1U));
    s->extremes = s->kind != (uint8_t)FILTER_KIND_COUNT;
    s->calls_end = 0;
    return true;
}

static bool begin_random(filter_sequence_t *s)
{
    s->kind = any_kind(s->episode);
    uint32_t how = random32(&s->random);
    s->signal = (uint8_t)(ANYTHING + how % (SIGNALS - ANYTHING));
    s->noise_bits = (uint8_t)(how >> 24) & 15U;
    s->coasts = ((how >> 16) & 7U) == 0U ? 200U : 30U;
    s->calls_end = (uint16_t)(50U + ((how >> 8) & 0xFFU));
    s->level = random32(&s->random);
    s->slope = (uint16_t)(random32(&s->random) >> (16U + (how >> 28)));
    return init_random(&s->filter, (filter_kind_t)s->kind, &s->random, &s->refused);
}

/* Two's complement of 16 bits, without an implementation-defined conversion. */
static int16_t as_i16(uint16_t v)
{
    return (v < 0x8000U) ? (int16_t)v : (int16_t)(-1 - (int16_t)(0xFFFFU - v));
}

static int16_t random_input(filter_sequence_t *s)
{
    uint32_t v = random32(&s->random);
    switch (s->signal) {
    case NOISE:
        s->level += ((v & 0x3FU) == 0U) ? v >> 16 : 0U; /* a step now and then */
        return as_i16((uint16_t)(s->level + ((v >> 16) >> s->noise_bits)));
    case RAMP:
        s->level += s->slope;
        return as_i16((uint16_t)(s->level + ((v >> 16) >> s->noise_bits)));
    case RANDOM_RAILS:
        return ((v & 0x100U) != 0U) ? INT16_MAX : INT16_MIN;
    default:
        return as_i16((uint16_t)(v >> 16));
    }
}

static int16_t next_input(filter_sequence_t *s)
{
    bool odd = (s->calls & 1U) != 0U;
    switch (s->signal) {
    case ALTERNATING_RAILS:
        return odd ? FILTER_Z_MIN_LSB : FILTER_Z_MAX_LSB;
    case HIGH_RAIL:
        return INT16_MAX;
    case LOW_RAIL:
        return INT16_MIN;
    case ZERO_AND_MINUS_ONE:
        return odd ? -1 : 0;
    case SPIKES:
        if ((s->calls & 7U) != 7U) {
            return 0;
        }
        return ((s->calls & 8U) != 0U) ? FILTER_Z_MAX_LSB : FILTER_Z_MIN_LSB;
    default:
        return random_input(s);
    }
}

enum call { UPDATE, MISSING, RESET, SET_NOISE, RESTART };

/* Extremes: 28 updates, 4 missing samples, 4 updates, a reset to a rail, updates. */
static enum call next_call(filter_sequence_t *s)
{
    if (s->extremes) {
        switch (s->calls) {
        case 28:
        case 29:
        case 30:
        case 31:
            return MISSING;
        case 36:
            return RESET;
        default:
            return UPDATE;
        }
    }
    uint8_t what = (uint8_t)(random32(&s->random) >> 16);
    if (what < 6U) {
        return (what < 1U) ? RESET : SET_NOISE; /* a reset settles for 64 steps */
    }
    if (what == 6U) {
        return RESTART;
    }
    return (what < 7U + s->coasts) ? MISSING : UPDATE;
}

static int32_t make_call(filter_sequence_t *s)
{
    switch (next_call(s)) {
    case MISSING:
        return filter_missing(&s->filter);
    case RESET:
        filter_reset(&s->filter, next_input(s));
        break;
    case SET_NOISE:
        filter_set_noise(&s->filter, random32(&s->random) >> s->noise_bits);
        break;
    case RESTART:
        filter_restart(&s->filter);
        break;
    case UPDATE:
        s->updates++;
        return filter_update(&s->filter, next_input(s));
    }
    return estimate_of(&s->filter);
}

static void add_to_crc(filter_sequence_t *s, const filter_probe_t *probe, int32_t x_lsb_q16)
{
    uint32_t crc = crc32_u32(s->crc, (uint32_t)x_lsb_q16);
    crc = crc32_u32(crc, (uint32_t)probe->rate_lsb_q16);
    crc = crc32_u32(crc, (uint32_t)probe->innovation_lsb_q16);
    crc = crc32_u32(crc, probe->p_lsb2_q8);
    crc = crc32_u32(crc, probe->gate_lsb2_q8);
    crc = crc32_u16(crc, probe->gain_uq16);
    s->crc = crc32_u8(crc, s->filter.flags);
}

const char *sequence_run(filter_sequence_t *s, uint32_t updates)
{
    while (s->updates < updates) {
        if (s->calls == s->calls_end) {
            s->calls = 0;
            if (!(s->extremes ? begin_extreme(s) : begin_random(s))) {
                return "legal, refused";
            }
            s->episode++;
            continue;
        }
        int32_t x_lsb_q16 = make_call(s);
        s->calls++;
        filter_probe_t probe;
        filter_probe(&s->filter, &probe);
        add_to_crc(s, &probe, x_lsb_q16);
        const char *broken = broken_bound(&s->filter, &probe, x_lsb_q16);
        if (broken != NULL) {
            return broken;
        }
    }
    return NULL;
}
