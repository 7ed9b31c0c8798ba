/* Structurally shortened robust filter: the rule MIXTURE_SHORTENED of mixture.h with a given share of outliers. */
#include "shrf.h"

const filter_descriptor_t shrf_descriptor FX_FLASH = { "shrf", MIXTURE_PARAMETERS, mixture_parameters };

void shrf_defaults(shrf_config_t *config, uint16_t rate_dhz)
{
    mixture_defaults(config, rate_dhz);
}

void shrf_configure(shrf_t *f, const shrf_config_t *config)
{
    mixture_configure(f, config, false);
}

bool shrf_init(shrf_t *f, const shrf_config_t *config)
{
    return mixture_init(f, config, false);
}

void shrf_set_noise(shrf_t *f, uint32_t r_lsb2_q8)
{
    two_state_wide_set_noise(&f->core, r_lsb2_q8);
}

void shrf_reset(shrf_t *f, int16_t z0_lsb)
{
    mixture_reset(f, z0_lsb);
}

bool shrf_reset_step(shrf_t *f, int16_t z0_lsb, uint8_t step)
{
    return mixture_reset_step(f, z0_lsb, step);
}

/* Scaling: input any int16, clamped to -4096..4095 LSB; output Q15.16, |x| <= 4608 LSB; the rest as in mixture.h. */
int32_t shrf_update(shrf_t *f, int16_t z_lsb)
{
    return mixture_update(f, z_lsb, MIXTURE_SHORTENED);
}

int32_t shrf_coast(shrf_t *f)
{
    return two_state_wide_coast(&f->core);
}

void shrf_damp(shrf_t *f)
{
    two_state_wide_damp(&f->core);
}

void shrf_hold(shrf_t *f)
{
    two_state_wide_hold(&f->core);
}

void shrf_restart(shrf_t *f)
{
    two_state_wide_restart(&f->core);
}

uint8_t shrf_flags(const shrf_t *f)
{
    return f->core.flags;
}

void shrf_probe(const shrf_t *f, filter_probe_t *out)
{
    two_state_wide_probe(&f->core, 0, out);
}
