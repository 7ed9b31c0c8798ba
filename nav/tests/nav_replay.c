/*
 * The navigation image on the PC: frames on standard input, what the board would send on standard output. The same link
 * and the same filter; only the line is this file.
 */
#include <stdio.h>

#include "hal_time.h"
#include "hal_uart.h"
#include "hal_watchdog.h"
#include "nav_link.h"

enum { ROOM = 200 };

void hal_uart_init(uint32_t baud)
{
    (void)baud;
}

uint8_t hal_uart_tx_room(void)
{
    return ROOM;
}

bool hal_uart_tx_write(const char *line, uint8_t length)
{
    return fwrite(line, 1, length, stdout) == length && fflush(stdout) == 0; /* whoever waits for it reads a pipe */
}

bool hal_uart_rx(uint8_t *byte)
{
    int next = getchar();
    *byte = (uint8_t)next;
    return next != EOF;
}

uint32_t hal_time_us(void)
{
    return 0;
}

void hal_wake_at(uint32_t t_us)
{
    (void)t_us;
}

hal_reset_t hal_reset_cause(void)
{
    return HAL_RESET_POWER_ON;
}

int main(void)
{
    link_start();
    while (link_pass()) {
    }
    return ferror(stdout) != 0;
}
