/* The tracker, once for every law: any state, any law that keeps what law.h says, any order of calls. */
#define RATE_END 2147483647
#define TURN_END 603979776 /* of synth_plus: a rate between two estimates */
#define CELLS
#include "law.h"

/* By powers of 2 of the rate: so many 25 ms pass within a period. */
#define PACE_OF(f, from) ((from) <= (f)->rate_dhz < 2 * (from) && (f)->quarter_dhz < 2 * (from))
#define PACE(f)                                                                                                       \
    (PACE_OF(f, 32) || PACE_OF(f, 64) || PACE_OF(f, 128) || PACE_OF(f, 256) || PACE_OF(f, 512) || PACE_OF(f, 1024) || \
     PACE_OF(f, 2048) || PACE_OF(f, 4096) || PACE_OF(f, 8192) || PACE_OF(f, 16384) || PACE_OF(f, 32768))
#define BOUND(f)                                                                                              \
    (TRACKED(f) && (f)->quarters <= 4 && FLAG((f)->negative) && FLAG((f)->broken) && FLAG((f)->identifies) && \
     PACE(f) && (STARTING(f) || (f)->collected == 5))

#define LAW_STATE f->x_lsb_q16, f->rate_lsb, f->size_lsb_uq16, f->gain_uq16, f->flags, f->negative, f->broken, f->own
#define LAW_SEES f->x_lsb_q16, f->rate_lsb, f->own, f->rate_dhz, f->collected, f->previous_lsb

/*@ requires 50 <= f->rate_dhz <= 40000 && f->collected == 0 && f->rate_lsb == 0;
    requires 50 <= config->rate_dhz <= 40000;
    assigns LAW_STATE, f->rate_max_lsb \from *config, LAW_SEES;
    ensures TRACKED(f) && FLAG(f->negative) && FLAG(f->broken);
*/
static void law_set_up(filter_t *f, const filter_config_t *config);
/*@ requires TRACKED(f) && 3 <= r_lsb2_q8 <= 256000;
    assigns f->own \from r_lsb2_q8, LAW_SEES;
    ensures STARTING(f) || f->collected == 5;
*/
static void law_set_noise(filter_t *f, uint32_t r_lsb2_q8);
/*@ assigns \result \from f->own; */
static uint32_t law_own_noise(const filter_t *f);
/*@ requires TRACKED(f) && f->collected == 5 && f->rate_lsb == 0;
    requires SAMPLE_Q16(f->x_lsb_q16);
    assigns LAW_STATE, f->previous_lsb \from settled, LAW_SEES;
    ensures TRACKED(f) && FLAG(f->negative) && FLAG(f->broken);
*/
static void law_start(filter_t *f, bool settled);
/*@ requires TRACKED(f) && f->collected == 5 && what <= STEP_SETTLE;
    requires SAMPLE(z_lsb);
    assigns LAW_STATE \from z_lsb, what, LAW_SEES;
    ensures TRACKED(f) && FLAG(f->negative) && FLAG(f->broken);
*/
static void law_step(filter_t *f, int16_t z_lsb, uint8_t what);
/*@ requires TRACKED(f) && f->collected == 5;
    assigns f->rate_lsb, f->own \from first, LAW_SEES;
    ensures TRACKED(f);
*/
static void law_fade(filter_t *f, bool first);
/*@ requires TRACKED(f);
    assigns out->p_lsb2_q8, out->gate_lsb2_q8, out->gain_uq16 \from LAW_SEES;
*/
static void law_report(const filter_t *f, filter_probe_t *out);
/*@ assigns *config \from *config; */
static void law_standard(filter_config_t *config);
/*@ assigns \result \from *config;
    ensures FLAG(\result);
*/
static bool law_together(const filter_config_t *config);

/*@ requires 1 <= count <= 5;
    assigns \result \from ascending_lsb[0 .. 4], count;
    ensures SAMPLE_Q16(\result);
*/
int32_t filter_tracker_median_q16(const int16_t *ascending_lsb, uint8_t count);

/*@ ensures \result == 0 ==> BOUND(f); */
filter_answer_t filter_init(filter_t *f, const filter_law_t *law, const filter_config_t *config);
/*@ requires BOUND(f); ensures BOUND(f); */
void filter_set_noise(filter_t *f, uint32_t r_lsb2_q8);
/*@ requires BOUND(f); ensures BOUND(f); */
void filter_reset(filter_t *f, int16_t z0_lsb);
/*@ requires BOUND(f); ensures BOUND(f); ensures WITHIN(\result, X_MAX_Q16); */
int32_t filter_update(filter_t *f, int16_t z_lsb);
/*@ requires BOUND(f); ensures BOUND(f); ensures WITHIN(\result, X_MAX_Q16); */
int32_t filter_missing(filter_t *f);
/*@ requires BOUND(f) || (TRACKED(f) && FLAG(f->negative) && f->quarters == 0 && PACE(f)); ensures BOUND(f); */
void filter_restart(filter_t *f);

#include "filter.c"

/* Any law: its parameters with any ranges, with and without what is optional, of every trait. */
static filter_parameter_t any_parameters[2];
static const filter_parameter_t *const list[2] = { &any_parameters[0], &any_parameters[1] };
static filter_law_t any;

static void any_law(uint8_t traits)
{
    any.traits = traits;
    any.parameter_count = 2;
    any.parameters = list;
    any.standard = ANY_BOOL() ? law_standard : NULL;
    any.together = ANY_BOOL() ? law_together : NULL;
    any.set_up = law_set_up;
    any.set_noise = law_set_noise;
    any.own_noise = ANY_BOOL() ? law_own_noise : NULL;
    any.start = law_start;
    any.step = law_step;
    any.fade = ((traits & 32U) != 0U) ? law_fade : NULL;
    any.report = law_report;
    for (uint8_t i = 0; i < 2U; i++) {
        any_parameters[i].zero_means_off = ANY_U8(0, 1);
        any_parameters[i].min = ANY_S32(S32_MIN, INT32_MAX);
        any_parameters[i].max = ANY_S32(S32_MIN, INT32_MAX);
        any_parameters[i].standard = ANY_S32(S32_MIN, INT32_MAX);
    }
}

/* Running (collected 5) or at the start, at a rate from from_dhz to twice it. */
static void any_filter(filter_t *f, uint8_t collected, uint16_t from_dhz)
{
    any_tracked(f, &any);
    for (uint8_t i = 0; i < sizeof f->own; i++) {
        ((uint8_t *)&f->own)[i] = ANY_U8(0, UINT8_MAX);
    }
    if (collected < FILTER_RUNNING) {
        any_samples(f, collected);
    } else { /* as the first twenty bytes, of which the tracker may halve some */
        f->own.kalman.p.p11 = ANY_U32(0, UINT32_MAX);
        f->own.kalman.p.p12 = ANY_U32(0, UINT32_MAX);
        f->own.kalman.p.p22 = ANY_U32(0, UINT32_MAX);
    }
    f->rate_dhz = ANY_U16((from_dhz < 50U) ? 50 : from_dhz, (from_dhz < 32768U) ? 2U * from_dhz - 1U : 40000U);
    f->quarter_dhz = ANY_U16(0, (from_dhz < 32768U) ? 2U * from_dhz - 1U : 39999U);
}

/* All traits, all rates, all parts of the start. */
#define EACH_LAW(traits) for (uint8_t traits = 0; traits < 64U; traits++)
#define EACH_RATE(dhz) for (uint32_t dhz = 32; dhz <= 32768U; dhz *= 2U)
#define EACH_START(collected) for (uint8_t collected = 0; collected <= FILTER_RUNNING; collected++)

void proof_tracker_bounded(void)
{
    filter_t f;
    f.flags = ANY_U8(0, UINT8_MAX);
    for (int16_t cell = -128; cell < 128; cell++) {
        (void)tracker_bounded(&f, ANY_S32(16777216L * cell, 16777216L * cell + 16777215L));
    }
}

void proof_filter_tracker_meet(void)
{
    filter_t f;
    for (int32_t cell = -9; cell <= 8; cell++) {
        f.x_lsb_q16 = ANY_S32(33554432L * cell, 33554432L * cell + 33554431L);
        //@ admit WITHIN(f.x_lsb_q16, X_MAX_Q16);
        filter_tracker_meet(&f, ANY_S16(FILTER_Z_MIN_LSB, FILTER_Z_MAX_LSB));
    }
    f.x_lsb_q16 = X_MAX_Q16;
    filter_tracker_meet(&f, ANY_S16(FILTER_Z_MIN_LSB, FILTER_Z_MAX_LSB));
}

static void turn_from(int32_t low, int32_t high)
{
    filter_t f;
    any_tracked(&f, NULL);
    f.rate_lsb = ANY_S32(low, high);
    f.rate_max_lsb = ANY_U32(0, X_MAX_Q16);
    filter_tracker_turn(&f, 0);
    //@ check usual: WITHIN(f.rate_lsb, X_MAX_Q16);
    f.rate_lsb = ANY_S32(low, high);
    f.rate_max_lsb = ANY_U32(0, TURN_END);
    filter_tracker_turn(&f, 0);
}

/*
 * Any sum, as the rate of a change of 0, on which alone the result depends; and the sums that come nearest to 32 bits.
 */
void proof_filter_tracker_turn(void)
{
    filter_t f;
    any_tracked(&f, NULL);
    f.rate_max_lsb = ANY_U32(0, TURN_END);
    f.negative = false;
    f.rate_lsb = ANY_S32(X_MAX_Q16 + 1L, 3L * X_MAX_Q16);
    filter_tracker_turn(&f, ANY_S32(0, 2L * X_MAX_Q16));
    f.negative = true;
    f.rate_lsb = ANY_S32(-3L * X_MAX_Q16, -X_MAX_Q16 - 1L);
    filter_tracker_turn(&f, ANY_S32(0, 2L * X_MAX_Q16));
    turn_from(-3L * X_MAX_Q16, -X_MAX_Q16 - 1L);
    turn_from(-X_MAX_Q16, -1);
    turn_from(0, X_MAX_Q16);
    turn_from(X_MAX_Q16 + 1L, 3L * X_MAX_Q16);
}

/* A signed word of program memory is read as an unsigned one. Options: -no-warn-signed-downcast */
void proof_flash_i32(void)
{
    int32_t word = ANY_S32(S32_MIN, -1);
    (void)flash_i32(&word);
    word = ANY_S32(0, INT32_MAX);
    (void)flash_i32(&word);
}

void proof_filter_tracker_limited_r(void)
{
    (void)filter_tracker_limited_r(ANY_U32(0, UINT32_MAX));
}

void proof_filter_tracker_limited_z(void)
{
    int16_t z_lsb = filter_tracker_limited_z(ANY_Z());
    //@ check SAMPLE(z_lsb);
}

/* Whole: filter_tracker_limited_r */
void proof_filter_tracker_default_r_lsb2_q8(void)
{
    uint32_t r_lsb2_q8 = filter_tracker_default_r_lsb2_q8(ANY_U16(0, 40000));
    //@ check 3 <= r_lsb2_q8 <= 30720;
}

void proof_filter_tracker_median_q16(void)
{
    filter_t f;
    any_samples(&f, 5);
    for (uint8_t count = 1; count <= FILTER_WARM_UP_SAMPLES; count++) {
        (void)filter_tracker_median_q16(f.own.start.ascending_lsb, count);
    }
}

/* Any configuration of any descriptor: legal or refused. Options: -eva-split-return-function filter_judge:full */
void proof_filter_init(void)
{
    for (uint8_t traits = 0; traits < 2U; traits++) {
        EACH_RATE(dhz)
        {
            any_law(traits);
            filter_config_t config = { ANY_U16((uint16_t)((dhz == 32U) ? 50U : dhz),
                                               (uint16_t)((dhz < 32768U) ? 2U * dhz - 1U : 40000U)),
                                       { 0 } };
            config.value[0] = ANY_S32(S32_MIN, INT32_MAX);
            config.value[1] = ANY_S32(S32_MIN, INT32_MAX);
            filter_t f;
            (void)filter_init(&f, &any, &config);
            config = filter_defaults(&any, config.rate_dhz);
        }
    }
    any_law(0);
    filter_t f;
    filter_config_t config = { ANY_U16(0, 49), { 0 } };
    filter_answer_t slow = filter_init(&f, &any, &config);
    config.rate_dhz = ANY_U16(40001, UINT16_MAX);
    filter_answer_t fast = filter_init(&f, &any, &config);
    //@ check rate: slow == FILTER_REFUSED_RATE && fast == FILTER_REFUSED_RATE;
    (void)filter_name(&any);
    (void)filter_worst_cycles(&any);
}

/* A value below or above its range is told by its number. */
void proof_filter_judge(void)
{
    any_law(0);
    any_parameters[0].zero_means_off = 0;
    any_parameters[0].min = -1000;
    any_parameters[0].max = 1000;
    any_parameters[1].zero_means_off = 1;
    any_parameters[1].min = 3;
    any_parameters[1].max = INT32_MAX;
    any.together = NULL;
    filter_config_t config = { ANY_U16(50, 40000), { 0 } };
    filter_answer_t off = filter_judge(&any, &config);
    config.value[1] = ANY_S32(3, INT32_MAX);
    config.value[0] = ANY_S32(-1000, 1000);
    filter_answer_t legal = filter_judge(&any, &config);
    config.value[0] = ANY_S32(S32_MIN, -1001);
    filter_answer_t below = filter_judge(&any, &config);
    config.value[0] = ANY_S32(1001, INT32_MAX);
    filter_answer_t above = filter_judge(&any, &config);
    config.value[0] = 0;
    config.value[1] = ANY_S32(S32_MIN, -1);
    filter_answer_t negative = filter_judge(&any, &config);
    config.value[1] = ANY_S32(1, 2);
    filter_answer_t small = filter_judge(&any, &config);
    //@ check taken: off == FILTER_ACCEPTED && legal == FILTER_ACCEPTED;
    //@ check first: below == FILTER_REFUSED_FIRST && above == FILTER_REFUSED_FIRST;
    //@ check second: negative == FILTER_REFUSED_FIRST + 1 && small == FILTER_REFUSED_FIRST + 1;
}

void proof_filter_set_noise(void)
{
    filter_t f;
    any_law(0);
    EACH_START(collected)
    {
        any_filter(&f, collected, 1024);
        filter_set_noise(&f, ANY_U32(0, UINT32_MAX));
    }
}

void proof_filter_own_noise_lsb2_q8(void)
{
    filter_t f;
    any_law(0);
    any_filter(&f, FILTER_RUNNING, 1024);
    (void)filter_own_noise_lsb2_q8(&f);
}

void proof_filter_limited(void)
{
    filter_t f;
    any_law(0);
    any_filter(&f, FILTER_RUNNING, 1024);
    f.q_limited = ANY_BOOL();
    (void)filter_limited(&f);
}

void proof_filter_reset(void)
{
    filter_t f;
    for (uint8_t settles = 0; settles < 2U; settles++) {
        any_law((settles != 0U) ? LAW_COVARIANCE : 0);
        EACH_START(collected)
        {
            any_filter(&f, collected, 1024);
            filter_reset(&f, ANY_Z());
        }
    }
}

void proof_filter_update(void)
{
    filter_t f;
    for (uint8_t first = 0; first < 2U; first++) {
        any_law((first != 0U) ? LAW_FIRST_SAMPLE : 0);
        EACH_START(collected)
        {
            any_filter(&f, collected, 1024);
            (void)filter_update(&f, ANY_S16(S16_MIN, FILTER_Z_MIN_LSB - 1));
            any_filter(&f, collected, 1024);
            (void)filter_update(&f, ANY_S16(FILTER_Z_MIN_LSB, FILTER_Z_MAX_LSB));
            any_filter(&f, collected, 1024);
            (void)filter_update(&f, ANY_S16(FILTER_Z_MAX_LSB + 1, 32767));
        }
    }
}

void proof_filter_missing(void)
{
    filter_t f;
    for (uint8_t traits = 0; traits < 4U; traits++) {
        any_law((uint8_t)(((traits & 1U) != 0U ? LAW_COVARIANCE : 0) + ((traits & 2U) != 0U ? 32 : 0)));
        EACH_RATE(dhz)
        {
            EACH_START(collected)
            {
                any_filter(&f, collected, (uint16_t)dhz);
                f.flags = 0;
                (void)filter_missing(&f);
                any_filter(&f, collected, (uint16_t)dhz);
                f.flags = FILTER_COASTED;
                (void)filter_missing(&f);
            }
        }
    }
}

void proof_filter_restart(void)
{
    filter_t f;
    any_law(0);
    EACH_START(collected)
    {
        any_filter(&f, collected, 1024);
        filter_restart(&f);
    }
}

void proof_filter_probe(void)
{
    filter_t f;
    filter_probe_t probe;
    for (uint8_t fine = 0; fine < 2U; fine++) {
        any_law((fine != 0U) ? LAW_FINE_RATE : 0);
        EACH_START(collected)
        {
            any_filter(&f, collected, 1024);
            filter_probe(&f, &probe);
        }
    }
}

/* The prediction that tests call, and the rest of the verbs. */
void proof_tracker_rest(void)
{
    filter_t f;
    any_law(0);
    any_tracked(&f, &any);
    filter_tracker_limit_rate(&f, ANY_U32(0, 1000000), 16);
    //@ check whole: f.rate_max_lsb <= X_MAX_Q16;
    filter_tracker_limit_rate(&f, ANY_U32(0, 1000000), 24);
    //@ check fine: f.rate_max_lsb <= 2130706432;
    uint16_t k = filter_tracker_memory_k_uq16(ANY_U16(1, 60000), ANY_U16(50, 40000), 32);
    //@ check least: 32 <= k <= 39322;
    k = filter_tracker_memory_k_uq16(ANY_U16(1, 60000), ANY_U16(50, 40000), 256);
    //@ check shortest: 256 <= k <= 39322;
    (void)filter_tracker_fading_variance(ANY_U32(3, 256000), ANY_U16(0, 39322));
    (void)filter_parameter_words(&filter_parameter_r);
}
