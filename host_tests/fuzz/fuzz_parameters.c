/*
 * Calibration and parameters of the filters once more, for judging: by their descriptors and filter_init, sharing
 * nothing with firmware/.
 */
#include <stdio.h>
#include <string.h>

#include "filter_list.h"
#include "fuzz_commands.h"

static const filter_parameter_t *named(const settings_t *s, const char *name, unsigned *which)
{
    const filter_law_t *law = filter_listed((filter_kind_t)s->choice.filter);
    for (*which = 0; *which < filter_parameter_count(law); ++*which) {
        const filter_parameter_t *parameter = filter_parameter(law, (uint8_t)*which);
        if (strcmp(parameter->words, name) == 0) {
            return parameter;
        }
    }
    return NULL;
}

/* The filter takes the value with the user's others. */
static bool taken(const settings_t *s, unsigned which, uint32_t value)
{
    filter_t f;
    const filter_law_t *law = filter_listed((filter_kind_t)s->choice.filter);
    filter_config_t config = filter_defaults(law, s->rate_dhz);
    for (unsigned i = 0; i < CHOICE_PARAMETERS_MAX; i++) {
        if (s->choice.own >> i & 1u) {
            config.value[i] = (int32_t)s->choice.parameters[i];
        }
    }
    config.value[which] = (int32_t)value;
    return filter_init(&f, law, &config) == FILTER_ACCEPTED;
}

bool expected_parameter(settings_t *s, const char *name, const char *value, char reply[REPLY_TEXT])
{
    unsigned which;
    const filter_parameter_t *parameter = named(s, name, &which);
    if (parameter == NULL) {
        return false;
    }
    snprintf(reply, REPLY_TEXT, "# %s ", name);
    if (value == NULL) {
        return true;
    }
    double v = 0.0;
    double one = (double)(1ul << parameter->fraction_bits);
    bool legal = expected_number(value, parameter->fraction_bits, &v);
    bool off = parameter->zero_means_off && v * one == 0.0;
    legal = legal && (off || (v * one >= parameter->min && v * one <= parameter->max));
    uint32_t stored = legal ? (uint32_t)(int64_t)(v * one) : 0;
    if (!legal || !taken(s, which, stored)) {
        snprintf(reply, REPLY_TEXT, "# refused 4: illegal value; %s ", name);
        return true;
    }
    s->choice.parameters[which] = stored;
    s->choice.own = (uint8_t)(s->choice.own | 1u << which);
    return true;
}

/* The three numbers of a text, in units of 2^-bits; false: not three, or none of them legal. */
static bool three(const char *text, unsigned bits, double low, double high, int32_t out[3])
{
    char word[3][64];
    int end = 0;
    if (sscanf(text, "%63[^ ]%*[ ]%63[^ ]%*[ ]%63[^ ]%n", word[0], word[1], word[2], &end) != 3 || text[end] != '\0') {
        return false;
    }
    for (int i = 0; i < 3; i++) {
        double v;
        if (!expected_number(word[i], bits, &v) || v < low || v > high) {
            return false;
        }
        out[i] = (int32_t)(v * (double)(1ul << bits));
    }
    return true;
}

/* Gravity from 0.85 to 1.15 g. */
static bool long_enough(const int32_t q14[3])
{
    double square = ((double)q14[0] * q14[0] + (double)q14[1] * q14[1] + (double)q14[2] * q14[2]) / 268435456.0;
    return square >= 0.85 * 0.85 && square <= 1.15 * 1.15;
}

bool expected_vector(settings_t *s, const char *name, const char *value, char reply[REPLY_TEXT])
{
    static const struct {
        const char *name;
        unsigned bits;
        double low, high;
    } vectors[FUZZ_VECTORS] = { { "offset", 4, -80.0, 80.0 },
                                { "scale", 6, 200.0, 330.0 },
                                { "level", 14, -1.0, 1.0 } };
    unsigned which = 0;
    while (which < FUZZ_VECTORS && strcmp(name, vectors[which].name) != 0) {
        which++;
    }
    if (which == FUZZ_VECTORS) {
        return false;
    }
    snprintf(reply, REPLY_TEXT, "# %s ", name);
    if (value == NULL) {
        return true;
    }
    int32_t v[3];
    if (!three(value, vectors[which].bits, vectors[which].low, vectors[which].high, v) ||
        (which == 2 && !long_enough(v))) {
        snprintf(reply, REPLY_TEXT, "# refused 4: illegal value; %s ", name);
        return true;
    }
    calibration_t *c = &s->calibration;
    for (int i = 0; i < 3; i++) {
        int16_t *fields[FUZZ_VECTORS] = { &c->offset_lsb_q4[i], (int16_t *)&c->scale_lsb_per_g_uq6[i],
                                          &c->level_q14[i] };
        *fields[which] = (int16_t)v[i];
    }
    return true;
}

bool expected_axes(settings_t *s, const char *value)
{
    static const char *const rotations[] = { "xyz",   "yzx",   "zxy",   "-x-yz",  "-xy-z", "x-y-z", "-y-zx", "-yz-x",
                                             "y-z-x", "-z-xy", "-zx-y", "z-x-y",  "-xzy",  "x-zy",  "xz-y",  "-x-z-y",
                                             "-yxz",  "y-xz",  "yx-z",  "-y-x-z", "-zyx",  "z-yx",  "zy-x",  "-z-y-x" };
    for (size_t i = 0; i < sizeof rotations / sizeof rotations[0]; i++) {
        if (strcmp(value, rotations[i]) == 0) {
            for (int axis = 0; axis < 3; axis++) {
                int8_t sign = *value == '-' ? -1 : 1;
                value += *value == '-';
                s->calibration.axes[axis] = (int8_t)(sign * (*value++ - 'w'));
            }
            return true;
        }
    }
    return false;
}
