/* auto: any int16, any state within its bounds; the same bounds afterwards. */
#include "auto_bounds.h"
/*@ ensures \result ==> BOUND(f); */
bool auto_init(auto_t *f, const auto_config_t *config);
/*@ requires f->gate_sigma_q8 <= 4096; ensures NOISE(f); */
void auto_set_noise(auto_t *f, uint32_t r_lsb2_q8);
/*@ requires BOUND(f); ensures BOUND(f); */
void auto_reset(auto_t *f, int16_t z0_lsb);
/*@ requires BOUND(f); ensures BOUND(f); */
bool auto_reset_step(auto_t *f, int16_t z0_lsb, uint8_t step);
/*@ requires BOUND(f); ensures BOUND(f); ensures WITHIN_X(\result); */
int32_t auto_update(auto_t *f, int16_t z_lsb);
/*@ requires BOUND(f); ensures BOUND(f); ensures WITHIN_X(\result); */
int32_t auto_coast(auto_t *f);
/*@ requires BOUND(f); ensures BOUND(f); */
void auto_gap(auto_t *f);
/*@ requires BOUND(f); ensures BOUND(f); */
void auto_damp(auto_t *f);
/*@ requires BOUND(f); ensures BOUND(f); */
void auto_hold(auto_t *f);

#include "filter_common.c"
#include "fx.c"
/* Other entries prove functions of these names. */
#define predict predict_member
#define correct correct_member
#define step step_member
#define legal legal_auto
#include "auto.c"
#include "auto_setup.c"

/*@ requires TOLD(f) && NOISE(f) && RUNNING(f);
    requires i < 3 && SAMPLE(z_lsb);
    assigns f->u.members[i], f->flags \from *f, i, z_lsb;
    assigns a->innovation_lsb_q16, a->gain_uq16, a->flags \from f->u.members[i].x_lsb_q16, f->gate_lsb_uq8, z_lsb;
    ensures \initialized(&a->innovation_lsb_q16) && \initialized(&a->gain_uq16) && \initialized(&a->flags);
    ensures MEMBER(&f->u.members[i]);
    ensures -U_END <= a->innovation_lsb_q16 <= U_END;
    ensures a->gain_uq16 <= GAIN_END;
*/
static void step_member(auto_t *f, uint8_t i, int16_t z_lsb, answer_t *a);

static void any_told(auto_t *f)
{
    f->innovation_lsb_q16 = ANY_S32(-U_END, U_END);
    f->gate_lsb_uq8 = ANY_U32(0, GATE_END);
    f->rate_max_lsb_q16 = ANY_U32(0, X_MAX_Q16);
    f->r_lsb2_q8 = ANY_U32(3, 256000);
    f->eight_sigmas_lsb_uq8 = ANY_U16(0, UINT16_MAX);
    for (uint8_t i = 0; i < (uint8_t)AUTO_MEMBERS; i++) {
        f->final_k_uq16[i] = ANY_U16(K_LEAST, K_END);
    }
    f->still_uq16 = ANY_U16(0, UINT16_MAX);
    f->gate_sigma_q8 = ANY_U16(0, 4096);
    f->gain_uq16 = ANY_U16(0, UINT16_MAX);
    f->chosen = ANY_U8(0, 2);
    f->shown = ANY_U8(0, 2);
    f->flags = ANY_U8(0, UINT8_MAX);
}

static void any_member(auto_member_t *m)
{
    m->x_lsb_q16 = ANY_S32(-X_MAX_Q16, X_MAX_Q16);
    m->rate_lsb_q16 = ANY_S32(-X_MAX_Q16, X_MAX_Q16);
    m->score_lsb2_uq8 = ANY_U32(0, SCORE_END);
    m->k_uq16 = ANY_U16(K_LEAST, K_END);
    m->refused = ANY_S8(-4, 4);
}

static void any_run(auto_t *f)
{
    any_told(f);
    for (uint8_t i = 0; i < (uint8_t)AUTO_MEMBERS; i++) {
        any_member(&f->u.members[i]);
    }
    f->collected = FILTER_WARM_UP_SAMPLES;
}

static void any_start(auto_t *f, uint8_t from_collected, uint8_t to_collected)
{
    any_told(f);
    f->collected = ANY_U8(from_collected, to_collected);
    f->flags = ANY_BOOL() ? FILTER_WARMING_UP : FILTER_WARMING_UP | FILTER_COASTED;
    for (uint8_t i = 0; i < FILTER_WARM_UP_SAMPLES; i++) {
        f->u.start_lsb[i] = ANY_S16(FILTER_Z_MIN_LSB, FILTER_Z_MAX_LSB);
    }
}

void proof_within_x(void)
{
    auto_t f;
    any_run(&f);
    (void)within_x(&f, ANY_S32(-2L * X_MAX_Q16, -X_MAX_Q16 - 1L));
    (void)within_x(&f, ANY_S32(-X_MAX_Q16, -1));
    (void)within_x(&f, ANY_S32(0, X_MAX_Q16 - 1L));
    (void)within_x(&f, ANY_S32(X_MAX_Q16, 2L * X_MAX_Q16));
}

void proof_within_rate(void)
{
    auto_t f;
    any_run(&f);
    (void)within_rate(&f, ANY_S32(-TURNED_END, -X_MAX_Q16 - 1L));
    (void)within_rate(&f, ANY_S32(-X_MAX_Q16, -1));
    (void)within_rate(&f, ANY_S32(0, X_MAX_Q16));
    (void)within_rate(&f, ANY_S32(X_MAX_Q16 + 1L, TURNED_END));
}

/* Run by run, so that what is counted and what is tested stay one. */
void proof_refused(void)
{
    for (int8_t run = -4; run <= 4; run++) {
        auto_t f;
        any_run(&f);
        f.u.members[1].refused = run;
        (void)refused(&f.u.members[1], ANY_BOOL(), ANY_S16(FILTER_Z_MIN_LSB, FILTER_Z_MAX_LSB));
    }
}

/* k in ranges, x in ranges of 256 LSB with every innovation towards a sample that one of the range can have. */
static void any_correction(uint16_t from_k, uint16_t to_k)
{
    for (int32_t x = -X_MAX_Q16; x < X_MAX_Q16; x += 256L * 65536L) {
        int32_t to_x = x + 256L * 65536L;
        auto_t f;
        any_run(&f);
        auto_member_t *m = &f.u.members[1];
        m->k_uq16 = ANY_U16(from_k, to_k);
        if (to_x >= -Z_LEAST_Q16) {
            m->x_lsb_q16 = ANY_S32(x, to_x);
            (void)correct(&f, m, ANY_U16(K_LEAST, K_END), ANY_U32(0, (uint32_t)(to_x + Z_LEAST_Q16) / 256U), true);
        }
        any_member(m);
        m->k_uq16 = ANY_U16(from_k, to_k);
        if (x <= Z_MOST_Q16) {
            m->x_lsb_q16 = ANY_S32(x, to_x);
            (void)correct(&f, m, ANY_U16(K_LEAST, K_END), ANY_U32(0, (uint32_t)(Z_MOST_Q16 - x) / 256U), false);
        }
    }
}

/* Uses: within_rate */
void proof_correct_member(void)
{
    for (uint16_t k = K_LEAST; k < 16384U; k *= 2U) {
        any_correction(k, (uint16_t)(2U * k - 1U));
    }
    any_correction(16384, 20479);
    any_correction(20480, 25599);
    any_correction(25600, 31999);
    any_correction(32000, K_END);
}

/*
 * Uses: within_x, refused, correct_member.
 * The score in ranges, so narrow towards its end that what is forgotten of all of a range makes room for the square.
 */
void proof_step_member(void)
{
    uint32_t to = 0;
    for (uint32_t from = 0; from <= SCORE_END; from = to + 1U) {
        uint32_t room = SCORE_END - SQUARE_END + (from >> 3);
        to = (from < room / 8U) ? 8U * from + 7U : room;
        for (uint8_t i = 0; i < (uint8_t)AUTO_MEMBERS; i++) {
            auto_t f;
            answer_t answer;
            any_run(&f);
            f.u.members[i].score_lsb2_uq8 = ANY_U32(from, to);
            step(&f, i, ANY_S16(FILTER_Z_MIN_LSB, FILTER_Z_MAX_LSB), &answer);
        }
    }
}

/* The score of the member in force by powers of 2: a thirty-second of it is less. */
void proof_choose(void)
{
    for (uint8_t chosen = 0; chosen < (uint8_t)AUTO_MEMBERS; chosen++) {
        auto_t f;
        any_run(&f);
        f.chosen = chosen;
        f.u.members[chosen].score_lsb2_uq8 = 0;
        choose(&f);
        for (uint32_t from = 1; from <= SCORE_END; from *= 2U) {
            any_run(&f);
            f.chosen = chosen;
            f.u.members[chosen].score_lsb2_uq8 = ANY_U32(from, (2U * from <= SCORE_END) ? 2U * from - 1U : SCORE_END);
            choose(&f);
        }
    }
}

void proof_warm_up(void)
{
    for (uint8_t collected = 0; collected < FILTER_WARM_UP_SAMPLES; collected++) {
        auto_t f;
        any_start(&f, collected, collected);
        (void)warm_up(&f, ANY_S16(FILTER_Z_MIN_LSB, FILTER_Z_MAX_LSB));
    }
}

/*
 * Uses: fx_isqrt32, fx_normalise, rounded.
 * All legal configurations, with a gate and without, then all with one parameter below or above its range.
 */
void proof_auto_init(void)
{
    auto_t f;
    auto_config_t config;
    for (uint8_t number = 0; number < CASES(7); number++) {
        config.rate_dhz = any_u16(part_of(number, 0), 50, 40000);
        config.gate_sigma_q8 = any_u16(part_of(number, 1), 256, 4096);
        config.r_lsb2_q8 = any_u32(part_of(number, 2), 3, 256000, UINT32_MAX);
        config.slow_ms = any_u16(part_of(number, 3), 1, 60000);
        config.middle_ms = any_u16(part_of(number, 4), 1, 60000);
        config.fast_ms = any_u16(part_of(number, 5), 1, 60000);
        config.rate_max_lsb_s = any_u32(part_of(number, 6), 10, 1000000, UINT32_MAX);
        if (part_of(number, 1) == BELOW_RANGE) {
            config.gate_sigma_q8 = ANY_U16(1, 255);
        }
        bool taken = auto_init(&f, &config);
        //@ check alone: number == 0 || taken == 0;
        if (number == 0U) {
            config.gate_sigma_q8 = 0;
            (void)auto_init(&f, &config);
        }
    }
    auto_defaults(&config, ANY_U16(0, UINT16_MAX));
    (void)auto_together(&config);
}

/* Uses: fx_isqrt32 */
void proof_auto_set_noise(void)
{
    auto_t f;
    any_run(&f);
    auto_set_noise(&f, ANY_U32(0, UINT32_MAX));
    //@ check running: BOUND(&f);
    any_start(&f, 0, 4);
    auto_set_noise(&f, ANY_U32(0, UINT32_MAX));
    //@ check starting: BOUND(&f);
}

void proof_auto_reset(void)
{
    auto_t f;
    any_run(&f);
    auto_reset(&f, ANY_Z());
    any_start(&f, 0, 4);
    auto_reset(&f, ANY_Z());
}

void proof_auto_reset_step(void)
{
    auto_t f;
    any_run(&f);
    (void)auto_reset_step(&f, ANY_Z(), ANY_U8(0, UINT8_MAX));
    any_start(&f, 0, 4);
    (void)auto_reset_step(&f, ANY_Z(), ANY_U8(0, UINT8_MAX));
}

/* Uses: warm_up, step_member, choose */
void proof_auto_update(void)
{
    auto_t f;
    any_run(&f);
    (void)auto_update(&f, ANY_Z());
    any_start(&f, 0, 4);
    (void)auto_update(&f, ANY_Z());
}

/* Uses: within_x */
void proof_auto_coast(void)
{
    auto_t f;
    any_run(&f);
    (void)auto_coast(&f);
    for (uint8_t collected = 0; collected < FILTER_WARM_UP_SAMPLES; collected++) {
        any_start(&f, collected, collected);
        (void)auto_coast(&f);
    }
}

/* What is told of missing samples, of states as those of a coast. */
void proof_auto_gap(void)
{
    auto_t f;
    any_run(&f);
    auto_gap(&f);
    any_start(&f, 0, 4);
    auto_gap(&f);
    any_run(&f);
    auto_damp(&f);
    any_start(&f, 0, 4);
    auto_damp(&f);
    any_run(&f);
    auto_hold(&f);
    any_start(&f, 0, 4);
    auto_hold(&f);
    any_run(&f);
    auto_restart(&f);
    //@ check running: BOUND(&f);
    any_start(&f, 0, 4);
    auto_restart(&f);
    //@ check starting: BOUND(&f);
}

/* Uses: fx_normalise, rounded */
void proof_auto_probe(void)
{
    auto_t f;
    filter_probe_t probe;
    any_run(&f);
    auto_probe(&f, &probe);
    for (uint8_t collected = 0; collected < FILTER_WARM_UP_SAMPLES; collected++) {
        any_start(&f, collected, collected);
        auto_probe(&f, &probe);
    }
    (void)auto_flags(&f);
}
