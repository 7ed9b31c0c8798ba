/* UART line: a byte takes ten bit times each way. The rings are those of the AVR. */
#include "hal_uart.h"

#include <stdlib.h>
#include <string.h>

#include "hal_host_private.h"
#include "hal_ring.h"
#include "hal_sleep.h"

enum {
    TX_SIZE = HAL_UART_TX_SIZE,
    RX_SIZE = HAL_UART_RX_SIZE,
    TX_MASK = TX_SIZE - 1,
    RX_MASK = RX_SIZE - 1,
    TYPED_MAX = 8192
};

static uint8_t tx_buffer[TX_SIZE];
static uint8_t rx_buffer[RX_SIZE];
static hal_ring_t tx;
static hal_ring_t rx;
static uint8_t rx_lost;
static bool rx_gap;
static uint32_t baud_rate;
static uint64_t byte_cycles;
static uint64_t tx_at;
static bool tx_shifting;
static uint64_t rx_at;
static char typed[TYPED_MAX];
static size_t typed_length, typed_next;
static unsigned rx_count;

void host_uart_begin(void)
{
    tx = (hal_ring_t){ 0, 0, 0 };
    rx = (hal_ring_t){ 0, 0, 0 };
    rx_lost = 0;
    rx_gap = false;
    tx_at = HOST_NEVER;
    tx_shifting = false;
    rx_at = HOST_NEVER;
    typed_length = 0;
    typed_next = 0;
    rx_count = 0;
}

uint32_t hal_host_baud(void)
{
    return baud_rate;
}

void hal_host_type(const char *text)
{
    size_t length = strlen(text);
    if (length == 0) {
        return;
    }
    if (typed_next == typed_length) {
        typed_next = 0;
        typed_length = 0;
        rx_at = hal_host_now() + byte_cycles;
    }
    if (typed_length + length > TYPED_MAX) {
        abort();
    }
    memcpy(&typed[typed_length], text, length);
    typed_length += length;
}

uint64_t host_uart_next(void)
{
    uint64_t tx_next = hal_host_faults()->tx_stuck ? HOST_NEVER : tx_at;
    return tx_next < rx_at ? tx_next : rx_at;
}

static void count_lost(void)
{
    if (rx_lost != UINT8_MAX) {
        rx_lost++;
    }
}

static void receive(uint8_t byte)
{
    hal_wake();
    rx_count++;
    unsigned every = hal_host_faults()->corrupt_rx_every;
    bool framing_error = every != 0 && rx_count % every == 0;
    if (hal_ring_room(&rx, RX_MASK) == 0) {
        count_lost();
        rx_gap = true;
        return;
    }
    if (framing_error) {
        count_lost();
    }
    hal_ring_stage(&rx, rx_buffer, RX_MASK, (framing_error || rx_gap) ? 0 : byte);
    hal_ring_commit(&rx);
    rx_gap = false;
}

void host_uart_step(void)
{
    if (tx_at <= hal_host_now() && !hal_host_faults()->tx_stuck) {
        if (hal_ring_empty(&tx)) {
            tx_at = HOST_NEVER;
            tx_shifting = false;
        } else {
            uint8_t byte = hal_ring_take(&tx, tx_buffer, TX_MASK);
            if (host_config()->on_tx != NULL) {
                host_config()->on_tx(byte);
            }
            tx_at = hal_host_now() + byte_cycles;
        }
    }
    if (rx_at <= hal_host_now()) {
        receive((uint8_t)typed[typed_next++]);
        rx_at = typed_next < typed_length ? hal_host_now() + byte_cycles : HOST_NEVER;
    }
}

void hal_uart_init(uint32_t baud)
{
    uint32_t divider = ((uint32_t)(HAL_HOST_HZ / 8) + baud / 2) / baud;
    baud_rate = baud;
    byte_cycles = (uint64_t)divider * 80u;
    tx_at = HOST_NEVER;
    tx_shifting = false;
}

uint8_t hal_uart_tx_room(void)
{
    return hal_ring_room(&tx, TX_MASK);
}

void hal_uart_tx_stage(uint8_t byte)
{
    hal_ring_stage(&tx, tx_buffer, TX_MASK, byte);
}

void hal_uart_tx_commit(void)
{
    hal_ring_commit(&tx);
    if (!tx_shifting && !hal_ring_empty(&tx)) {
        tx_shifting = true;
        tx_at = hal_host_now();
    }
}

void hal_uart_tx_discard(void)
{
    hal_ring_discard(&tx);
}

bool hal_uart_tx_write(const char *line, uint8_t length)
{
    if (hal_uart_tx_room() < length) {
        return false;
    }
    while (length-- != 0) {
        hal_ring_stage(&tx, tx_buffer, TX_MASK, (uint8_t)*line++);
    }
    hal_uart_tx_commit();
    return true;
}

bool hal_uart_tx_idle(void)
{
    return hal_ring_empty(&tx) && !tx_shifting;
}

uint8_t hal_uart_tx_sent(void)
{
    return tx.tail;
}

bool hal_uart_rx(uint8_t *byte)
{
    if (hal_ring_empty(&rx)) {
        return false;
    }
    *byte = hal_ring_take(&rx, rx_buffer, RX_MASK);
    return true;
}

uint8_t hal_uart_rx_lost(void)
{
    return rx_lost;
}
