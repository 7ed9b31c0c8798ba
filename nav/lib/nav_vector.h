/* Three components: products in a fixed order of operations. */
#ifndef NAV_VECTOR_H
#define NAV_VECTOR_H

#include "nav_real.h"

#ifdef __cplusplus
extern "C" {
#endif

/* a . b */
nav_real_t nav_dot(const nav_real_t a[3], const nav_real_t b[3]);

/* out += a x b; out is neither of them. */
void nav_add_cross(nav_real_t out[3], const nav_real_t a[3], const nav_real_t b[3]);

/* out += factor a */
void nav_add_scaled(nav_real_t out[3], nav_real_t factor, const nav_real_t a[3]);

#ifdef __cplusplus
}
#endif
#endif
