/* The list's common interface: why a configuration is refused, of any bytes of it. */
#include "eva.h"

#include "filter_any.h"

/* One translation unit, so that the descriptors are there: names that each file has for itself get the filter's. */
#include "filter_common.c"
#include "fx.c"
#include "two_state.c"

#include "reacquire.c"

#define parameters parameters_kf
#include "kf.c"
#undef parameters
#define parameters parameters_sprf
#include "sprf.c"
#undef parameters
#define parameters parameters_lrf
#include "lrf.c"
#undef parameters
#define parameters parameters_soft
#include "soft.c"
#undef parameters
#define predict_covariance predict_wide_covariance
#include "two_state_wide.c"
#undef predict_covariance
#define parameters parameters_sprf_paper
#include "sprf_paper.c"
#undef parameters
#include "af.c"
#include "mixture.c"
#include "pbf.c"
#include "shrf.c"
#undef limited
#include "synth_common.c"
#include "synth_opt.c"
#include "synth_plus.c"
#define parameters parameters_synth
#define step step_synth
#define update update_synth
#include "synth.c"
#undef parameters
#undef step
#undef update

#define parameters parameters_adaptive
#define legal legal_adaptive
#define forget forget_adaptive
#include "adaptive_setup.c"
#undef parameters
#undef legal
#undef forget
#define parameters parameters_auto
#define legal legal_auto
#define k_of k_of_auto
#define variance_lsb2_q8 variance_lsb2_q8_auto
#include "auto_setup.c"
#undef parameters
#undef legal
#undef k_of
#undef variance_lsb2_q8
#define parameters parameters_kf3
#define limited limited_kf3
#define correct correct_kf3
#define take take_kf3
#define predict predict_kf3
#define moved moved_kf3
#define less less_kf3
#include "kf3.c"
#undef parameters
#undef limited
#undef predict
#undef take
#undef correct
#undef moved
#undef less

#include "filter_parameter.c"

#include "filter_any.c"

/*
 * Any bytes of a configuration of any filter, and an unknown one. What is told is a parameter of the descriptor, or one
 * of filter_refusal. Options: -eva-split-return-function filter_parameter_in_range:full,filter_any_refused:full
 */
void proof_filter_any_refused(void)
{
    //@ loop unroll 16;
    for (uint8_t kind = 0; kind <= (uint8_t)FILTER_KIND_COUNT; kind++) {
        filter_any_config_t config;
        //@ loop unroll 64;
        for (uint8_t i = 0; i < sizeof config; i++) {
            ((uint8_t *)&config)[i] = ANY_U8(0, UINT8_MAX);
        }
        uint8_t why = filter_any_refused((filter_kind_t)kind, &config);
        //@ check told: why < 8 || why >= 253;
        //@ check unknown: kind < FILTER_KIND_COUNT || why == FILTER_REFUSED_KIND;
        if (kind < (uint8_t)FILTER_KIND_COUNT) {
            filter_any_defaults((filter_kind_t)kind, &config, ANY_U16(50, 40000));
        }
    }
}

/* Any bytes of a configuration of any filter; of synth_plus, which adds its parameters, any within their ranges. */
void proof_filter_any_together(void)
{
    //@ loop unroll 16;
    for (uint8_t kind = 0; kind <= (uint8_t)FILTER_KIND_COUNT; kind++) {
        filter_any_config_t config;
        //@ loop unroll 64;
        for (uint8_t i = 0; i < sizeof config; i++) {
            ((uint8_t *)&config)[i] = ANY_U8(0, UINT8_MAX);
        }
        if (kind == (uint8_t)FILTER_KIND_synth_plus) {
            config.of_synth_plus.k = ANY_U16(0, K_MAX);
            config.of_synth_plus.b0_uq16 = ANY_U16(SYNTH_B0_MIN_UQ16, SYNTH_B0_MAX_UQ16);
            config.of_synth_plus.b1_q16 = ANY_S32(-SYNTH_A1_MAX_Q16, SYNTH_A1_MAX_Q16);
            config.of_synth_plus.b2_q16 = ANY_S32(-SYNTH_A1_MAX_Q16, SYNTH_A1_MAX_Q16);
        }
        bool taken = filter_any_together((filter_kind_t)kind, &config);
        //@ check unknown: kind < FILTER_KIND_COUNT || taken == 0;
    }
}

/* Every parameter of every filter: its ends come back as they were put in, any value stays within the configuration. */
void proof_filter_parameter_set(void)
{
    //@ loop unroll 16;
    for (uint8_t kind = 0; kind < (uint8_t)FILTER_KIND_COUNT; kind++) {
        const filter_descriptor_t *descriptor = filter_any_descriptor((filter_kind_t)kind);
        //@ loop unroll 16;
        for (uint8_t i = 0; i < descriptor->parameter_count; i++) {
            const filter_parameter_t *parameter = &descriptor->parameters[i];
            filter_any_config_t config;
            filter_parameter_set(&config, parameter, (uint32_t)parameter->min);
            uint32_t least = filter_parameter_get(&config, parameter);
            filter_parameter_set(&config, parameter, (uint32_t)parameter->max);
            uint32_t most = filter_parameter_get(&config, parameter);
            //@ check kept: least == (uint32_t)parameter->min && most == (uint32_t)parameter->max;
            filter_parameter_set(&config, parameter, ANY_U32(0, UINT32_MAX));
        }
    }
}
