/* nav/lib with 9 and 12 states, in float and in double, behind one table of functions that speak double. */
#ifndef NAV_VARIANTS_H
#define NAV_VARIANTS_H

#include <stdbool.h>
#include <stdint.h>

/* As nav_answer_t. */
enum {
    ANSWER_TAKEN,
    ANSWER_GATED,
    ANSWER_BACKWARDS,
    ANSWER_LATE,
    ANSWER_NOT_FINITE,
    ANSWER_NO_LENGTH,
    ANSWER_OUT_OF_RANGE,
    ANSWER_QUEUE_FULL,
    ANSWER_GAP,
    ANSWERS
};

typedef struct {
    double quaternion[4], velocity[3], position[3], drift[3];
} nav_values_t;

typedef struct {
    nav_values_t start;
    double field[3];
    double gravity;
    double sigma[4];    /* of the start: position, velocity, attitude, drift */
    double walk[4];     /* the same */
    double measured[4]; /* velocity, position, down, field */
    double gate;
    uint32_t period_us;
} nav_setting_t;

/* A nav_t of any variant. */
typedef struct {
    double memory[512];
} nav_memory_t;

/* A row of H. */
typedef struct {
    double h[12];
} nav_test_row_t;

typedef struct {
    const char *name;
    int states;
    bool in_double;
    unsigned bytes;
    bool (*init)(nav_memory_t *nav, const nav_setting_t *setting);
    int (*imu)(nav_memory_t *nav, uint32_t t_us, const double rate[3], const double force[3]);
    int (*gps)(nav_memory_t *nav, uint32_t t_us, const double velocity[3], const double position[3]);
    int (*down)(nav_memory_t *nav, uint32_t t_us, double down);
    int (*field)(nav_memory_t *nav, uint32_t t_us, const double field[3]);
    void (*state)(const nav_memory_t *nav, nav_values_t *state);
    void (*variances)(const nav_memory_t *nav, double *variance);
    unsigned (*count)(const nav_memory_t *nav, int answer);
    int (*queued)(const nav_memory_t *nav);
    bool (*healthy)(const nav_memory_t *nav);
    /* the covariance alone */
    void (*ud_start)(nav_memory_t *nav, const double sigma[4]);
    void (*ud_phi)(nav_memory_t *nav, double step_s, const double force[3], const double dcm[9]);
    void (*ud_noise)(nav_memory_t *nav, int k, double variance);
    void (*ud_spread)(nav_memory_t *nav, const double *a, int k, double variance);
    double (*ud_scalar)(nav_memory_t *nav, const nav_test_row_t *row, double variance, double *gain);
    double (*least_d)(const nav_memory_t *nav);
    void (*covariance)(const nav_memory_t *nav, double *p); /* P, row-major */
    void (*noise_start)(nav_memory_t *nav, const double walk[4], uint32_t period_us);
    void (*noise_job)(nav_memory_t *nav, uint32_t t_us);
    /* pieces */
    bool (*tau)(double tau[6], const double field[3]);
    void (*dcm)(double dcm[9], const double quaternion[4]);
    void (*step)(nav_values_t *state, double force_ned[3], const double rate[3], const double force[3], double gravity,
                 double step_s);
    void (*correct)(nav_values_t *state, const double *x);
    void (*set_state)(nav_memory_t *nav, const nav_values_t *state);
    void (*break_covariance)(nav_memory_t *nav, int k, double d); /* puts D[k] in */
} nav_variant_t;

extern const nav_variant_t n9f, n9d, n12f, n12d;

/* All four, float first. */
enum { NAV_ALL = 4 };
extern const nav_variant_t *const nav_all[NAV_ALL];

#endif
