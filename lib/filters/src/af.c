/* Adaptive filter: the rule MIXTURE_BAYES of mixture.h with a learnt share of outliers. */
#include "af.h"

const filter_descriptor_t af_descriptor FX_FLASH = { "af", MIXTURE_PARAMETERS, mixture_parameters };

void af_defaults(af_config_t *config, uint16_t rate_dhz)
{
    mixture_defaults(config, rate_dhz);
    config->clean_uq16 = MIXTURE_CLEAN_MIN_UQ16; /* one half: no opinion */
}

void af_configure(af_t *f, const af_config_t *config)
{
    mixture_configure(f, config, true);
}

bool af_init(af_t *f, const af_config_t *config)
{
    return mixture_init(f, config, true);
}

void af_set_noise(af_t *f, uint32_t r_lsb2_q8)
{
    two_state_wide_set_noise(&f->core, r_lsb2_q8);
}

void af_reset(af_t *f, int16_t z0_lsb)
{
    mixture_reset(f, z0_lsb);
}

bool af_reset_step(af_t *f, int16_t z0_lsb, uint8_t step)
{
    return mixture_reset_step(f, z0_lsb, step);
}

/* Scaling: input any int16, clamped to -4096..4095 LSB; output Q15.16, |x| <= 4608 LSB; the rest as in mixture.h. */
int32_t af_update(af_t *f, int16_t z_lsb)
{
    return mixture_update(f, z_lsb, MIXTURE_BAYES);
}

int32_t af_coast(af_t *f)
{
    return two_state_wide_coast(&f->core);
}

void af_damp(af_t *f)
{
    two_state_wide_damp(&f->core);
}

void af_hold(af_t *f)
{
    two_state_wide_hold(&f->core);
}

void af_restart(af_t *f)
{
    two_state_wide_restart(&f->core);
}

uint8_t af_flags(const af_t *f)
{
    return f->core.flags;
}

void af_probe(const af_t *f, filter_probe_t *out)
{
    two_state_wide_probe(&f->core, 0, out);
}
