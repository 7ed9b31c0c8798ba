/* Pseudo-Bayesian filter: the rule MIXTURE_BAYES of mixture.h with a given share of outliers. */
#include "pbf.h"

const filter_descriptor_t pbf_descriptor FX_FLASH = { "pbf", MIXTURE_PARAMETERS, mixture_parameters };

void pbf_defaults(pbf_config_t *config, uint16_t rate_dhz)
{
    mixture_defaults(config, rate_dhz);
}

void pbf_configure(pbf_t *f, const pbf_config_t *config)
{
    mixture_configure(f, config, false);
}

bool pbf_init(pbf_t *f, const pbf_config_t *config)
{
    return mixture_init(f, config, false);
}

void pbf_set_noise(pbf_t *f, uint32_t r_lsb2_q8)
{
    two_state_wide_set_noise(&f->core, r_lsb2_q8);
}

void pbf_reset(pbf_t *f, int16_t z0_lsb)
{
    mixture_reset(f, z0_lsb);
}

bool pbf_reset_step(pbf_t *f, int16_t z0_lsb, uint8_t step)
{
    return mixture_reset_step(f, z0_lsb, step);
}

/* Scaling: input any int16, clamped to -4096..4095 LSB; output Q15.16, |x| <= 4608 LSB; the rest as in mixture.h. */
int32_t pbf_update(pbf_t *f, int16_t z_lsb)
{
    return mixture_update(f, z_lsb, MIXTURE_BAYES);
}

int32_t pbf_coast(pbf_t *f)
{
    return two_state_wide_coast(&f->core);
}

void pbf_damp(pbf_t *f)
{
    two_state_wide_damp(&f->core);
}

void pbf_hold(pbf_t *f)
{
    two_state_wide_hold(&f->core);
}

void pbf_restart(pbf_t *f)
{
    two_state_wide_restart(&f->core);
}

uint8_t pbf_flags(const pbf_t *f)
{
    return f->core.flags;
}

void pbf_probe(const pbf_t *f, filter_probe_t *out)
{
    two_state_wide_probe(&f->core, 0, out);
}
