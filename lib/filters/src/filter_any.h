/*
 * Any filter of the list behind one type: for firmware that selects by name and for tests that run over all.
 * The states share their memory (RAM of the largest); calls are a switch over direct calls, no function pointers.
 */
#ifndef FILTER_ANY_H
#define FILTER_ANY_H

#include "filter.h"
#include "filter_list.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum {
#define FILTER_ENUM(F) FILTER_KIND_##F,
    FILTER_LIST(FILTER_ENUM)
#undef FILTER_ENUM
        FILTER_KIND_COUNT
} filter_kind_t;

typedef union {
    uint16_t rate_dhz;                        /* every configuration begins with it */
#define FILTER_MEMBER(F) F##_config_t of_##F; /* of_: one filter is called as a word of C */
    FILTER_LIST(FILTER_MEMBER)
#undef FILTER_MEMBER
} filter_any_config_t;

typedef struct {
    uint8_t kind; /* filter_kind_t */
    union {
#define FILTER_MEMBER(F) F##_t of_##F;
        FILTER_LIST(FILTER_MEMBER)
#undef FILTER_MEMBER
    } state;
} filter_any_t;

/* Descriptor of a kind, in program memory: read it with the FX_FLASH readers of fx.h. NULL: kind not linked. */
const filter_descriptor_t *filter_any_descriptor(filter_kind_t kind);

/* Name of a kind, in program memory, as typed in `filter NAME`; the same as in its descriptor. */
const char *filter_any_name(filter_kind_t kind);

/* F_worst_cycles of a kind (filter.h). */
uint16_t filter_any_worst_cycles(filter_kind_t kind);

/* Kind whose name equals the text (RAM, NUL-terminated); FILTER_KIND_COUNT when none does. */
filter_kind_t filter_any_find(const char *name);

/*
 * As F_defaults and so on of filter.h, for the kind given or held. Unknown kinds, and kinds that are not linked: init
 * is false, the others do nothing.
 */
void filter_any_defaults(filter_kind_t kind, filter_any_config_t *config, uint16_t rate_dhz);
bool filter_any_init(filter_any_t *f, filter_kind_t kind, const filter_any_config_t *config);

/*
 * F_together and F_configure, for a program that has judged each parameter by its descriptor (filter_parameter.h): the
 * code of F_init that does so is not linked then.
 */
bool filter_any_together(filter_kind_t kind, const filter_any_config_t *config);
void filter_any_configure(filter_any_t *f, filter_kind_t kind, const filter_any_config_t *config);

void filter_any_set_noise(filter_any_t *f, uint32_t r_lsb2_q8);
void filter_any_reset(filter_any_t *f, int16_t z0_lsb);
bool filter_any_reset_step(filter_any_t *f, int16_t z0_lsb, uint8_t step);
int32_t filter_any_update(filter_any_t *f, int16_t z_lsb);
int32_t filter_any_coast(filter_any_t *f);
void filter_any_gap(filter_any_t *f);
void filter_any_damp(filter_any_t *f);
void filter_any_hold(filter_any_t *f);
void filter_any_restart(filter_any_t *f);
uint8_t filter_any_flags(const filter_any_t *f);
void filter_any_probe(const filter_any_t *f, filter_probe_t *out);

/*
 * Why filter_any_init refuses a configuration, to be asked after it did: the index of the descriptor's first parameter
 * that is outside its range, or one of filter_refusal.
 */
enum filter_refusal {
    FILTER_REFUSED_KIND = 253, /* there is no such filter */
    FILTER_REFUSED_RATE = 254, /* rate_dhz, which no descriptor lists */
    FILTER_REFUSED_TOGETHER =
        255 /* each is in its range: a gap in it (reacquire: 3, 5, 9) or a condition over several */
};
uint8_t filter_any_refused(filter_kind_t kind, const filter_any_config_t *config);

#ifdef __cplusplus
}
#endif
#endif
