/* Facts of a law from its descriptor, defaults and legal ranges: see filter.h. */
#include "tracker.h"

/*
 * Shared parameters. r: R of one sample. q: power density of the white acceleration; at the default fast tilt has the
 * least error, and at rest it is still less than half of raw (test_filter_accuracy). gate: in sigmas of the innovation.
 * reacquire: refused samples in a row that restart a filter; with 3, 5 and 9 the slope is a shift. ratemax: together
 * with R it limits how far apart two samples of such a run may lie.
 */
static const char common_r_words[] IN_FLASH = "r\0LSB2";
const filter_parameter_t filter_parameter_r IN_FLASH = { common_r_words,       8, 0, FILTER_R_MIN_LSB2_Q8,
                                                         FILTER_R_MAX_LSB2_Q8, 0 };
static const char common_q_words[] IN_FLASH = "q\0LSB2/s3";
const filter_parameter_t filter_parameter_q IN_FLASH = { common_q_words, 0, 0, 1, 1000000000, 10000 };
static const char common_gate_words[] IN_FLASH = "gate\0sigma";
const filter_parameter_t filter_parameter_gate IN_FLASH = { common_gate_words, 8, 1, 256, 4096, 768 };
static const char common_reacquire_words[] IN_FLASH = "reacquire\0samples";
const filter_parameter_t filter_parameter_reacquire IN_FLASH = { common_reacquire_words, 0, 1, 3, 9, 5 };
static const char common_ratemax_words[] IN_FLASH = "ratemax\0LSB/s";
const filter_parameter_t filter_parameter_ratemax IN_FLASH = { common_ratemax_words, 0, 0, 10, 1000000, 800 };

const char *filter_name(const filter_law_t *law)
{
    return law->name;
}

uint8_t filter_parameter_count(const filter_law_t *law)
{
    return flash_u8(&law->parameter_count);
}

const filter_parameter_t *filter_parameter(const filter_law_t *law, uint8_t index)
{
    const filter_parameter_t *const *list = (const filter_parameter_t *const *)flash_pointer(&law->parameters);
    return (const filter_parameter_t *)flash_pointer(&list[index]);
}

const char *filter_parameter_words(const filter_parameter_t *parameter)
{
    return (const char *)flash_pointer(&parameter->words);
}

uint16_t filter_worst_cycles(const filter_law_t *law)
{
    return flash_u16(&law->worst_cycles);
}

uint32_t filter_tracker_default_r_lsb2_q8(uint16_t rate_dhz)
{
    return filter_tracker_limited_r(((uint32_t)rate_dhz * 768U + 500U) / 1000U); /* 0.003 per 0.1 Hz, Q8 */
}

static int32_t flash_i32(const int32_t *p)
{
    return (int32_t)flash_u32((const uint32_t *)p);
}

void filter_set_defaults(filter_config_t *config, const filter_law_t *law, uint16_t rate_dhz)
{
    filter_tracker_clear(config, sizeof *config);
    config->rate_dhz = rate_dhz;
    int32_t *value = config->value;
    for (uint8_t i = 0; i < filter_parameter_count(law); i++) {
        const filter_parameter_t *parameter = filter_parameter(law, i);
        *value++ = (parameter == &filter_parameter_r) ? (int32_t)filter_tracker_default_r_lsb2_q8(rate_dhz)
                                                      : flash_i32(&parameter->standard);
    }
    void (*standard)(filter_config_t *) = FLASH_FUNCTION(&law->standard);
    if (standard != NULL) {
        standard(config);
    }
}

filter_config_t filter_defaults(const filter_law_t *law, uint16_t rate_dhz)
{
    filter_config_t config;
    filter_set_defaults(&config, law, rate_dhz);
    return config;
}

bool filter_in_range(const filter_parameter_t *parameter, int32_t value)
{
    if (value == 0 && flash_u8(&parameter->zero_means_off) != 0U) {
        return true;
    }
    return value >= flash_i32(&parameter->min) && value <= flash_i32(&parameter->max);
}

filter_answer_t filter_judge(const filter_law_t *law, const filter_config_t *config)
{
    if (config->rate_dhz < FILTER_RATE_MIN_DHZ || config->rate_dhz > FILTER_RATE_MAX_DHZ) {
        return FILTER_REFUSED_RATE;
    }
    for (uint8_t i = 0; i < filter_parameter_count(law); i++) {
        if (!filter_in_range(filter_parameter(law, i), config->value[i])) {
            return (filter_answer_t)(FILTER_REFUSED_FIRST + i);
        }
    }
    bool (*together)(const filter_config_t *) = FLASH_FUNCTION(&law->together);
    return (together == NULL || together(config)) ? FILTER_ACCEPTED : FILTER_REFUSED_TOGETHER;
}
