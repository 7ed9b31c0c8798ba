/* The virtual line can use every baud rate. */
#ifndef HAL_UART_PORT_H
#define HAL_UART_PORT_H

#define HAL_UART_REACHES(baud) ((baud) != 0)

#endif
