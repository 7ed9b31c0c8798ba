/*
 * In double-speed mode (F_CPU / 8) a frame tolerates a clock error of 2.2 % (115200 at 16 MHz and 57600 at 8 MHz are
 * 2.12 % too fast). A byte must last at least 160 cycles, because its interrupts take most of them. The divider is one
 * byte.
 */
#ifndef HAL_UART_PORT_H
#define HAL_UART_PORT_H

#define HAL_UART_DIVISOR(baud) ((F_CPU / 8 + (baud) / 2) / (baud))
#define HAL_UART_REACHES(baud)                                                           \
    (F_CPU / 16 >= (baud) && F_CPU / 8 * 1000 <= HAL_UART_DIVISOR(baud) * (baud)*1022 && \
     F_CPU / 8 * 1000 >= HAL_UART_DIVISOR(baud) * (baud)*978 && HAL_UART_DIVISOR(baud) <= 256)

#endif
