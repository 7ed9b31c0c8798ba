/* Alignment by the Earth's field (paper 003, 3.3.3). */
#include "nav_align.h"
#include "nav_root.h"
#include "nav_vector.h"

#define SHORTEST_SQUARED NAV_R(1e-20)
#define LONGEST_SQUARED NAV_R(1e12)
#define SOUTHERNMOST NAV_R(-0.5)

bool nav_align_unit(nav_real_t v[3])
{
    nav_real_t square = nav_dot(v, v);
    if (!(square >= SHORTEST_SQUARED && square <= LONGEST_SQUARED)) {
        return false;
    }
    nav_real_t inverse = 1 / nav_root(square);
    for (uint8_t i = 0; i < 3U; i++) {
        v[i] *= inverse;
    }
    return true;
}

bool nav_align_tau(nav_real_t tau[2][3], const nav_real_t field[3])
{
    nav_real_t m[3] = { field[0], field[1], field[2] };
    if (!nav_align_unit(m) || m[0] < SOUTHERNMOST) {
        return false;
    }
    nav_real_t share = 1 / (1 + m[0]);
    for (uint8_t i = 0; i < 2U; i++) {
        nav_real_t part = share * m[1U + i];
        tau[i][0] = -m[1U + i];
        for (uint8_t j = 0; j < 2U; j++) {
            tau[i][1U + j] = (nav_real_t)((i == j) ? 1 : 0) - part * m[1U + j];
        }
    }
    return true;
}

void nav_align_innovation(nav_real_t innovation[2], const nav_real_t tau[2][3], const nav_real_t dcm[9],
                          const nav_real_t direction[3])
{
    nav_real_t ned[3];
    for (uint8_t i = 0; i < 3U; i++) {
        ned[i] = nav_dot(dcm + 3U * i, direction);
    }
    innovation[0] = -nav_dot(tau[1], ned);
    innovation[1] = nav_dot(tau[0], ned);
}
