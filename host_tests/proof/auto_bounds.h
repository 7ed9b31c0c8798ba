/* What holds of auto before and after every call, and contracts of its parts. */
#ifndef AUTO_BOUNDS_H
#define AUTO_BOUNDS_H

#include "eva.h"
#include "fx_contracts.h"

#include "auto.h"

#define X_MAX_Q16 301989888   /* 4608 LSB */
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

#define WITHIN_X(x) (-X_MAX_Q16 <= (x) <= X_MAX_Q16)
#define SAMPLE(z) (-4096 <= (z) <= 4095)
#define MOTION(m) (WITHIN_X((m)->x_lsb_q16) && WITHIN_X((m)->rate_lsb_q16) && K_LEAST <= (m)->k_uq16 <= K_END)
#define MEMBER(m) (MOTION(m) && (m)->score_lsb2_uq8 <= SCORE_END && -5 < (m)->refused < 5)
#define FINAL_K(k) (K_LEAST <= (k) <= K_END)
#define NOISE(f) (3 <= (f)->r_lsb2_q8 <= 256000 && (f)->gate_lsb_uq8 <= GATE_END)
#define TOLD(f)                                                                                           \
    ((f)->rate_max_lsb_q16 <= X_MAX_Q16 && (f)->gate_sigma_q8 <= 4096 && FINAL_K((f)->final_k_uq16[0]) && \
     FINAL_K((f)->final_k_uq16[1]) && FINAL_K((f)->final_k_uq16[2]) && (f)->chosen < 3 && (f)->shown < 3)
#define RUNNING(f) \
    ((f)->collected == 5 && MEMBER(&(f)->u.members[0]) && MEMBER(&(f)->u.members[1]) && MEMBER(&(f)->u.members[2]))
#define START(lsb) (SAMPLE((lsb)[0]) && SAMPLE((lsb)[1]) && SAMPLE((lsb)[2]) && SAMPLE((lsb)[3]) && SAMPLE((lsb)[4]))
#define STARTING(f) ((f)->collected < 5 && ((f)->flags & FILTER_WARMING_UP) != 0 && START((f)->u.start_lsb))
#define BOUND(f) (TOLD(f) && NOISE(f) && -U_END <= (f)->innovation_lsb_q16 <= U_END && (STARTING(f) || RUNNING(f)))

/*@ requires -2 * X_MAX_Q16 <= x_lsb_q16 <= 2 * X_MAX_Q16;
    assigns f->flags, \result \from f->flags, x_lsb_q16;
    ensures WITHIN_X(\result);
*/
static inline int32_t within_x(auto_t *f, int32_t x_lsb_q16);

/*@ requires -TURNED_END <= rate_lsb_q16 <= TURNED_END && f->rate_max_lsb_q16 <= X_MAX_Q16;
    assigns f->flags, \result \from f->flags, f->rate_max_lsb_q16, rate_lsb_q16;
    ensures WITHIN_X(\result);
*/
static inline int32_t within_rate(auto_t *f, int32_t rate_lsb_q16);

/*@ requires SAMPLE(z_lsb) && WITHIN_X(m->x_lsb_q16) && WITHIN_X(m->rate_lsb_q16);
    requires -5 < m->refused < 5;
    assigns m->x_lsb_q16, m->rate_lsb_q16, m->k_uq16, m->refused, \result \from *m, below, z_lsb;
    ensures -5 < m->refused < 5;
    ensures WITHIN_X(m->x_lsb_q16) && WITHIN_X(m->rate_lsb_q16) && K_LEAST <= m->k_uq16 <= K_END;
*/
static uint8_t refused(auto_member_t *m, bool below, int16_t z_lsb);

/* The sample towards which x goes lies within its range. */
/*@ requires MOTION(m) && f->rate_max_lsb_q16 <= X_MAX_Q16 && FINAL_K(final_k);
    requires size_lsb_uq8 <= U_END / 256;
    requires reach: (below != 0 ==> m->x_lsb_q16 - 256 * size_lsb_uq8 >= -Z_LEAST_Q16) &&
                    (below == 0 ==> m->x_lsb_q16 + 256 * size_lsb_uq8 <= Z_MOST_Q16);
    assigns m->x_lsb_q16, m->rate_lsb_q16, m->k_uq16, f->flags, \result \from *m, *f, final_k, size_lsb_uq8, below;
    ensures MOTION(m);
    ensures \result <= GAIN_END;
*/
static inline uint16_t correct_member(auto_t *f, auto_member_t *m, uint16_t final_k, uint32_t size_lsb_uq8, bool below);

/*@ requires RUNNING(f) && f->chosen < 3;
    assigns f->chosen, f->flags \from *f;
    ensures f->chosen < 3;
*/
static void choose(auto_t *f);

/*@ requires STARTING(f) && SAMPLE(z_lsb) && TOLD(f);
    assigns f->u, f->collected, f->flags, \result \from *f, z_lsb;
    ensures WITHIN_X(\result) && f->flags == FILTER_WARMING_UP;
    ensures STARTING(f) || RUNNING(f);
*/
static int32_t warm_up(auto_t *f, int16_t z_lsb);

#endif
