/*
 * UART 8N1 with a transmit and a receive ring. Nothing waits. A line is staged byte by byte and becomes visible to the
 * interrupt only with the commit, so it goes out whole or not at all. All functions are for main.
 */
#ifndef HAL_UART_H
#define HAL_UART_H

#include <stdbool.h>
#include <stdint.h>

/* Bytes of the rings, powers of two up to 256, of which one stays free: an image may want others. */
#ifndef HAL_UART_RX_SIZE
#define HAL_UART_RX_SIZE 64
#endif
#ifndef HAL_UART_TX_SIZE
#define HAL_UART_TX_SIZE 256
#endif

/* Sets the rate, baud; only while nothing is being sent; received bytes stay. */
void hal_uart_init(uint32_t baud);

/* Bytes that can be staged. */
uint8_t hal_uart_tx_room(void);

/* Appends after the staged ones; the caller has checked the room. */
void hal_uart_tx_stage(uint8_t byte);

/* Hands the staged bytes to the interrupt. */
void hal_uart_tx_commit(void);

/* Forgets the staged bytes. */
void hal_uart_tx_discard(void);

/* Stages and commits a line; false if it does not fit. */
bool hal_uart_tx_write(const char *line, uint8_t length);

/* The ring is empty and the last stop bit sent. */
bool hal_uart_tx_idle(void);

/* Counts bytes handed to the line, wraps: progress. */
uint8_t hal_uart_tx_sent(void);

/* Takes one received byte, false when there is none; 0 stands where some were lost. */
bool hal_uart_rx(uint8_t *byte);

/* Bytes lost to a full ring, framing or overrun, saturating. */
uint8_t hal_uart_rx_lost(void);

/* The port's HAL_UART_REACHES(baud), for #if: the processor's clock makes this rate and has time for it. */
#include "hal_uart_port.h"

#endif
