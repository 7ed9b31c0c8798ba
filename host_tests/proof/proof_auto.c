/* auto: see law.h. */
#define Z_LEAST_Q16 268435456 /* 4096 LSB, below 0 */
#define Z_MOST_Q16 268369920  /* 4095 LSB */
#define U_END 570425344       /* 8704 LSB */
#define TURNED_END 517734400  /* 7900 LSB: 4608 + 0.36 x 8704, and what intervals add */
#define GATE_END 0x7FFFFFFF   /* none */
#define K_LEAST 256
#define K_END 39322
#define GAIN_END 63019      /* 0.96: of 0.84 what the widest interval of k keeps */
#define SQUARE_END 16776704 /* the square of any eight sigmas of 16 bits */
#define SCORE_END 134213639 /* 8 SQUARE_END + 7, below 2^27 */

#define MOTION(m) \
    (WITHIN((m)->x_lsb_q16, X_MAX_Q16) && WITHIN((m)->rate_lsb_q16, X_MAX_Q16) && K_LEAST <= (m)->k_uq16 <= K_END)
#define MEMBER(m) (MOTION(m) && (m)->score_lsb2_uq8 <= SCORE_END && -5 < (m)->refused < 5)
#define FINAL_K(k) (K_LEAST <= (k) <= K_END)
#define KEPT(f)                                                                       \
    ((f)->own.bank.gate_sigma_q8 <= 4096 && FINAL_K((f)->own.bank.final_k_uq16[0]) && \
     FINAL_K((f)->own.bank.final_k_uq16[1]) && FINAL_K((f)->own.bank.final_k_uq16[2]))
#define FORCE(f)                                                                                                    \
    (MEMBER(&(f)->own.bank.members[0]) && MEMBER(&(f)->own.bank.members[1]) && MEMBER(&(f)->own.bank.members[2]) && \
     (f)->own.bank.chosen < 3 && (f)->own.bank.shown < 3)
#define KINDS 1
#include "law.h"

/* kalman.c has a function of that name. */
#define correct correct_member

/*@ requires -TURNED_END <= rate_lsb_q16 <= TURNED_END && f->rate_max_lsb <= X_MAX_Q16;
    assigns f->flags, \result \from f->flags, f->rate_max_lsb, rate_lsb_q16;
    ensures WITHIN(\result, X_MAX_Q16);
*/
static inline int32_t within_rate(filter_t *f, int32_t rate_lsb_q16);

/*@ requires SAMPLE(z_lsb) && WITHIN(m->x_lsb_q16, X_MAX_Q16) && WITHIN(m->rate_lsb_q16, X_MAX_Q16);
    requires -5 < m->refused < 5;
    assigns m->x_lsb_q16, m->rate_lsb_q16, m->k_uq16, m->refused, \result \from *m, below, z_lsb;
    ensures -5 < m->refused < 5;
    ensures WITHIN(m->x_lsb_q16, X_MAX_Q16) && WITHIN(m->rate_lsb_q16, X_MAX_Q16) && K_LEAST <= m->k_uq16 <= K_END;
*/
static uint8_t refused(filter_member_t *m, bool below, int16_t z_lsb);

/* The sample towards which x goes lies within its range. */
/*@ requires MOTION(m) && f->rate_max_lsb <= X_MAX_Q16 && FINAL_K(final_k);
    requires size_lsb_uq8 <= U_END / 256;
    requires reach: (below != 0 ==> m->x_lsb_q16 - 256 * size_lsb_uq8 >= -Z_LEAST_Q16) &&
                    (below == 0 ==> m->x_lsb_q16 + 256 * size_lsb_uq8 <= Z_MOST_Q16);
    assigns m->x_lsb_q16, m->rate_lsb_q16, m->k_uq16, f->flags, \result \from *m, f->rate_max_lsb,
            f->flags, final_k, size_lsb_uq8, below;
    ensures MOTION(m);
    ensures \result <= GAIN_END;
*/
static inline uint16_t correct(filter_t *f, filter_member_t *m, uint16_t final_k, uint32_t size_lsb_uq8, bool below);

/*@ requires FORCE(f) && f->own.bank.chosen < 3;
    assigns f->own.bank.chosen, f->flags \from f->own, f->flags;
    ensures f->own.bank.chosen < 3;
*/
static void choose(filter_t *f);

#include "auto.c"

/*@ requires TRACKED(f) && KEPT(f) && FORCE(f) && gate_lsb_uq8 <= GATE_END;
    requires i < 3 && SAMPLE(z_lsb);
    assigns f->own.bank.members[i], f->flags \from f->own, f->rate_max_lsb, f->flags, i, z_lsb, gate_lsb_uq8;
    assigns a->innovation_lsb_q16, a->gain_uq16, a->flags \from f->own.bank.members[i].x_lsb_q16, gate_lsb_uq8, z_lsb;
    ensures \initialized(&a->innovation_lsb_q16) && \initialized(&a->gain_uq16) && \initialized(&a->flags);
    ensures MEMBER(&f->own.bank.members[i]);
    ensures -U_END <= a->innovation_lsb_q16 <= U_END;
    ensures a->gain_uq16 <= GAIN_END;
*/
static void step_member(filter_t *f, uint8_t i, int16_t z_lsb, uint32_t gate_lsb_uq8, answer_t *a);

static void any_member(filter_member_t *m)
{
    m->x_lsb_q16 = ANY_S32(-X_MAX_Q16, X_MAX_Q16);
    m->rate_lsb_q16 = ANY_S32(-X_MAX_Q16, X_MAX_Q16);
    m->score_lsb2_uq8 = ANY_U32(0, SCORE_END);
    m->k_uq16 = ANY_U16(K_LEAST, K_END);
    m->refused = ANY_S8(-4, 4);
}

static void any_own(filter_t *f, uint8_t kind)
{
    filter_auto_t *b = &f->own.bank;
    (void)kind;
    for (uint8_t i = 0; i < (uint8_t)AUTO_MEMBERS; i++) {
        any_member(&b->members[i]);
        b->final_k_uq16[i] = ANY_U16(K_LEAST, K_END);
    }
    b->chosen = ANY_U8(0, 2);
    b->shown = ANY_U8(0, 2);
    b->eight_sigmas_lsb_uq8 = ANY_U16(0, UINT16_MAX);
    b->gate_sigma_q8 = ANY_U16(0, 4096);
    b->still_uq16 = ANY_U16(0, UINT16_MAX);
}

void proof_within_rate(void)
{
    filter_t f;
    any_running(&f, &filter_law_auto, 0);
    (void)within_rate(&f, ANY_S32(-TURNED_END, -X_MAX_Q16 - 1L));
    (void)within_rate(&f, ANY_S32(-X_MAX_Q16, -1));
    (void)within_rate(&f, ANY_S32(0, X_MAX_Q16));
    (void)within_rate(&f, ANY_S32(X_MAX_Q16 + 1L, TURNED_END));
}

/* Run by run, so that what is counted and what is tested stay one. */
void proof_refused(void)
{
    for (int8_t run = -4; run <= 4; run++) {
        filter_t f;
        any_running(&f, &filter_law_auto, 0);
        f.own.bank.members[1].refused = run;
        (void)refused(&f.own.bank.members[1], ANY_BOOL(), ANY_S16(FILTER_Z_MIN_LSB, FILTER_Z_MAX_LSB));
    }
}

/* k in ranges, x in ranges of 256 LSB with every innovation towards a sample that one of the range can have. */
static void any_correction(uint16_t from_k, uint16_t to_k)
{
    for (int32_t x = -X_MAX_Q16; x < X_MAX_Q16; x += 256L * 65536L) {
        int32_t to_x = x + 256L * 65536L;
        filter_t f;
        any_running(&f, &filter_law_auto, 0);
        filter_member_t *m = &f.own.bank.members[1];
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

/* The score in ranges, so narrow towards its end that what is forgotten of all of a range makes room for the square. */
void proof_step_member(void)
{
    uint32_t to = 0;
    for (uint32_t from = 0; from <= SCORE_END; from = to + 1U) {
        uint32_t room = SCORE_END - SQUARE_END + (from >> 3);
        to = (from < room / 8U) ? 8U * from + 7U : room;
        for (uint8_t i = 0; i < (uint8_t)AUTO_MEMBERS; i++) {
            filter_t f;
            answer_t answer;
            any_running(&f, &filter_law_auto, 0);
            f.own.bank.members[i].score_lsb2_uq8 = ANY_U32(from, to);
            step_member(&f, i, ANY_S16(FILTER_Z_MIN_LSB, FILTER_Z_MAX_LSB), ANY_U32(0, GATE_END), &answer);
        }
    }
}

/* The score of the member in force by powers of 2: a thirty-second of it is less. */
void proof_choose(void)
{
    for (uint8_t chosen = 0; chosen < (uint8_t)AUTO_MEMBERS; chosen++) {
        filter_t f;
        any_running(&f, &filter_law_auto, 0);
        f.own.bank.chosen = chosen;
        f.own.bank.members[chosen].score_lsb2_uq8 = 0;
        choose(&f);
        for (uint32_t from = 1; from <= SCORE_END; from *= 2U) {
            any_running(&f, &filter_law_auto, 0);
            f.own.bank.chosen = chosen;
            f.own.bank.members[chosen].score_lsb2_uq8 = ANY_U32(from,
                                                                (2U * from <= SCORE_END) ? 2U * from - 1U : SCORE_END);
            choose(&f);
        }
    }
}

PROVE_LAW(auto)
