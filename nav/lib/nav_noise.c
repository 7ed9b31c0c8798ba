/* Process noise in turns: job 0 is the position, jobs 1 to 3 the velocity, 4 to 6 the attitude, 7 to 9 the drift. */
#include "nav_noise.h"
#include "nav_ud.h"

#define TURNED_RPS NAV_R(0.5)      /* may go unobserved in a gap, 1 sigma: a slow turn of a flying vehicle */
#define TURNED_MOST_RAD NAV_R(0.5) /* above this an error is no longer small, and no variance can represent it */
#define ACCELERATED_MPS2 NAV_R(5.0)
#define HALF NAV_R(0.5)

enum { OWE_ALL = 0x7F };

void nav_noise_start(nav_noise_t *noise, const nav_real_t walk[4], uint32_t period_us)
{
    for (uint8_t i = 0; i < 4U; i++) {
        noise->rate_us[i] = walk[i] * walk[i] / (nav_real_t)period_us;
    }
    noise->next = 0;
    noise->owed = 0;
    noise->gap_s = 0;
    nav_noise_restart(noise, 0);
}

void nav_noise_restart(nav_noise_t *noise, uint32_t t_us)
{
    for (uint8_t job = 0; job < NAV_NOISES; job++) {
        noise->t_us[job] = t_us;
    }
}

void nav_noise_owe(nav_noise_t *noise, nav_real_t gap_s)
{
    if (noise->owed == 0U) {
        noise->gap_s = 0;
    }
    noise->owed = OWE_ALL;
    noise->gap_s += gap_s;
}

/* Position, velocity, attitude, drift. */
static uint8_t block_of(uint8_t job)
{
    return (uint8_t)((job + 2U) / 3U);
}

static nav_real_t owed_variance(const nav_noise_t *noise, uint8_t block)
{
    nav_real_t sigma = noise->gap_s * ((block < 2U) ? ACCELERATED_MPS2 : TURNED_RPS);
    if (block == 0U) {
        sigma *= HALF * noise->gap_s;
    } else if (block == 2U && sigma > TURNED_MOST_RAD) {
        sigma = TURNED_MOST_RAD;
    }
    return sigma * sigma;
}

static bool owes(const nav_noise_t *noise, uint8_t job)
{
    return (noise->owed & (uint16_t)((uint16_t)1U << job)) != 0U;
}

/* The first job with an owed gap, otherwise the next with noise; NAV_NOISES if none. */
static uint8_t whose_turn(nav_noise_t *noise)
{
    for (uint8_t job = 0; noise->owed != 0U && job < NAV_NOISES; job++) {
        if (owes(noise, job)) {
            return job;
        }
    }
    for (uint8_t tried = 0; tried < NAV_NOISES; tried++) {
        uint8_t job = noise->next;
        noise->next = (uint8_t)((job + 1U < NAV_NOISES) ? job + 1U : 0U);
        if (noise->rate_us[block_of(job)] > 0) {
            return job;
        }
    }
    return NAV_NOISES;
}

void nav_noise_job(nav_noise_t *noise, nav_real_t ud[NAV_PACKED], uint32_t t_us)
{
    uint8_t job = whose_turn(noise);
    if (job == NAV_NOISES) {
        return;
    }
    nav_real_t variance = noise->rate_us[block_of(job)] * (nav_real_t)(t_us - noise->t_us[job]);
    noise->t_us[job] = t_us;
    if (owes(noise, job)) {
        variance += owed_variance(noise, block_of(job));
        noise->owed &= (uint16_t) ~(uint16_t)((uint16_t)1U << job);
    }
    uint8_t last = (uint8_t)(job + 2U);
    for (uint8_t k = (job == 0U) ? 0 : last; k <= last; k++) {
        nav_ud_noise(ud, k, variance);
    }
}
