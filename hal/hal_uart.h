/*
 * UART 8N1 with a transmit and a receive ring. Nothing blocks. A line is staged byte by byte and becomes visible to the
 * interrupt only with the commit, so it goes out whole or not at all. All functions are for main.
 */
#ifndef HAL_UART_H
#define HAL_UART_H

#include <stdbool.h>
#include <stdint.h>

/* Ring sizes in bytes, powers of two up to 256; one byte stays free. An image may set others. */
#ifndef HAL_UART_RX_SIZE
#define HAL_UART_RX_SIZE 64
#endif
#ifndef HAL_UART_TX_SIZE
#define HAL_UART_TX_SIZE 256
#endif

/* Sets the baud rate; only while nothing is being sent. Received bytes are kept. */
void hal_uart_init(uint32_t baud);

/* Number of bytes that can be staged. */
uint8_t hal_uart_tx_room(void);

/* Stages one more byte; the caller has checked the room. */
void hal_uart_tx_stage(uint8_t byte);

/* Hands the staged bytes to the interrupt. */
void hal_uart_tx_commit(void);

/* Drops the staged bytes. */
void hal_uart_tx_discard(void);

/* Stages and commits a line; false if it does not fit. */
bool hal_uart_tx_write(const char *line, uint8_t length);

/* The ring is empty and the last stop bit is out. */
bool hal_uart_tx_idle(void);

/* Counts the bytes handed to the UART; wraps. Shows progress. */
uint8_t hal_uart_tx_sent(void);

/* Takes one received byte; false if there is none. A 0 marks lost bytes. */
bool hal_uart_rx(uint8_t *byte);

/* Bytes lost to a full ring, framing errors or overruns; saturates. */
uint8_t hal_uart_rx_lost(void);

/*
 * The port defines HAL_UART_REACHES(baud), for #if: the processor's clock can make this baud rate and has time for it.
 */
#include "hal_uart_port.h"

#endif
