/*
 * UART 8N1 with a transmit and a receive ring. Nothing waits. A line is staged byte by byte and becomes visible to the
 * interrupt only with the commit, so it goes out whole or not at all.
 *
 *   void hal_uart_init(uint32_t baud)            set the rate; only while nothing is being sent; received bytes stay
 *                                                (main)
 *   uint8_t hal_uart_tx_room(void)               bytes that can be staged (main)
 *   void hal_uart_tx_stage(uint8_t byte)         append behind the staged ones; the caller has checked the room (main)
 *   void hal_uart_tx_commit(void)                hand the staged bytes to the interrupt (main)
 *   void hal_uart_tx_discard(void)               forget the staged bytes (main)
 *   bool hal_uart_tx_write(const char *line, uint8_t length)   stage and commit a line; false if it does not fit (main)
 *   bool hal_uart_tx_idle(void)                  ring empty and the last stop bit sent (main)
 *   uint8_t hal_uart_tx_sent(void)               counts bytes handed to the line, wraps: progress (main)
 *   bool hal_uart_rx(uint8_t *byte)              take one received byte, false when there is none; 0 stands where some
 *                                                were lost (main)
 *   uint8_t hal_uart_rx_lost(void)               bytes lost to a full ring, framing or overrun, saturating (main)
 *   HAL_UART_REACHES(baud)                       for #if: this processor's clock makes this rate and has time for it
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

#include "hal_port.h"

#endif
