/*
 * What an image grows by when a part is linked: each part is used as the firmware uses it if PARTS holds it.
 * make bench builds this with nothing, with each part alone, with all filters, and with all filters but one.
 */
#include <math.h>
#include <stdint.h>

#include "filter_list.h"
#include "float_filters.h"
#include "noise.h"
#include "tilt.h"

#include "../../firmware/output/rows.c"

/* -D'PARTS=(PART(kf) | PART(noise))' */
enum {
#define PART_OF(F) PART_##F, PART_float_##F,
    FILTER_LIST(PART_OF)
#undef PART_OF
        PART_noise,
    PART_angles,
    PART_float_angles,
    PART_format_row
};
#define PART(name) (1UL << (uint8_t)PART_##name)
#ifndef PARTS
#define PARTS 0UL
#endif
#define HAS(name) (((PARTS)&PART(name)) != 0UL)

static volatile int16_t in;
static volatile int32_t out;
static volatile float float_out;

#define USE(F)                                                                   \
    static void use_##F(void)                                                    \
    {                                                                            \
        static filter_t state;                                                   \
        filter_config_t config = filter_defaults(&filter_law_##F, (uint16_t)in); \
        (void)filter_init(&state, &filter_law_##F, &config);                     \
        filter_set_noise(&state, (uint32_t)out);                                 \
        filter_reset(&state, in);                                                \
        out = filter_update(&state, in);                                         \
        out = filter_missing(&state);                                            \
        out = state.flags;                                                       \
    }                                                                            \
    static void use_float_##F(void)                                              \
    {                                                                            \
        filter_config_t config = { 0 };                                          \
        config.rate_dhz = (uint16_t)in;                                          \
        float_##F##_start(&float_##F, &config, float_out);                       \
        float_##F##_set_noise(&float_##F, float_out);                            \
        float_out = float_##F##_update(&float_##F, in);                          \
        float_out = float_##F##_coast(&float_##F);                               \
    }
FILTER_LIST(USE)

static void use_noise(void)
{
    static noise_t state;
    filter_noise_init(&state, (uint16_t)in, in > 0);
    out = filter_noise_update(&state, in);
    filter_noise_gap(&state);
    out = (int32_t)filter_noise_r_lsb2_q8(&state);
}

static void use_angles(void)
{
    static tilt_t state;
    tilt_angles(&state, (const int32_t[]){ out, out, out });
    out = state.roll_cdeg + state.pitch_cdeg;
}

static void use_float_angles(void)
{
    float roll;
    float pitch;
    float_angles(&roll, &pitch, float_out, float_out, float_out);
    float_out = roll + pitch;
}

static void use_format_row(void)
{
    char line[ROW_MAX];
    row_t row;
    row.t_us = (uint32_t)out;
    row.flags = (uint16_t)in;
    for (uint8_t axis = 0; axis < 3; axis++) {
        row.lsb[axis] = in;
        row.mg[axis] = in;
    }
    row.roll_cdeg = in;
    row.pitch_cdeg = in;
    out = *write_csv(line, &row);
}

int main(void)
{
#define CALL(F)           \
    if (HAS(F)) {         \
        use_##F();        \
    }                     \
    if (HAS(float_##F)) { \
        use_float_##F();  \
    }
    FILTER_LIST(CALL)
    if (HAS(noise)) {
        use_noise();
    }
    if (HAS(angles)) {
        use_angles();
    }
    if (HAS(float_angles)) {
        use_float_angles();
    }
    if (HAS(format_row)) {
        use_format_row();
    }
    for (;;) {
        out = in;
        float_out = *(volatile float *)&float_out;
    }
}
