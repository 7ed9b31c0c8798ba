/* The virtual sensor runs the handler on each edge of its line. */
#ifndef HAL_DRDY_PORT_H
#define HAL_DRDY_PORT_H

#include <stdbool.h>

/* Counts the edge. False: the level is gone again, or the input flickers. */
bool host_drdy_counts(void);

#define HAL_DRDY_ISR()                \
    static void edge(void);           \
    void hal_host_drdy_handler(void); \
    void hal_host_drdy_handler(void)  \
    {                                 \
        if (host_drdy_counts()) {     \
            edge();                   \
        }                             \
    }                                 \
    static void edge(void)

#endif
