/* The virtual bus runs the handler after each event. */
#ifndef HAL_I2C_PORT_H
#define HAL_I2C_PORT_H

#define HAL_I2C_ISR()                \
    void hal_host_i2c_handler(void); \
    void hal_host_i2c_handler(void)

#endif
