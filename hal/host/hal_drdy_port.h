/* The virtual sensor runs the handler on each edge of its line. */
#ifndef HAL_DRDY_PORT_H
#define HAL_DRDY_PORT_H

#define HAL_DRDY_ISR()                \
    void hal_host_drdy_handler(void); \
    void hal_host_drdy_handler(void)

#endif
