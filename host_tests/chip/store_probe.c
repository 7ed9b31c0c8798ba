/*
 * Runs on the ATmega328P (simavr): loads what the store keeps and says `status N` and `set N` (or `set -`, where no
 * whole set came), then saves the next set, one byte after the other and asleep in between, says `saved` or `failed`
 * and `end`, and sleeps with interrupts off. Set n has n in every byte.
 */
#include <avr/interrupt.h>
#include <avr/sleep.h>

#include "hal_irq.h"
#include "hal_sleep.h"
#include "hal_time.h"
#include "hal_uart.h"
#include "machine.h"
#include "settings/store.h"

static uint8_t record[STORE_RECORD_SIZE];

static void say(flash_text_t words, char last)
{
    for (char c = flash_char(words); c != '\0'; c = flash_char(++words)) {
        hal_uart_tx_stage((uint8_t)c);
    }
    hal_uart_tx_stage((uint8_t)last);
    hal_uart_tx_stage('\n');
    hal_uart_tx_commit();
    while (!hal_uart_tx_idle()) {
        hal_sleep_until_wake();
    }
}

static bool is_whole(void)
{
    for (uint8_t i = 1; i < STORE_IMAGE_SIZE; i++) {
        if (record[i] != record[0]) {
            return false;
        }
    }
    return true;
}

/* Spans are measured up to here. */
__attribute__((noinline)) static void begun(void)
{
    __asm__ volatile("");
}

int main(void)
{
    hal_uart_init(115200);
    hal_time_init();
    hal_irq_enable();
    store_status_t status = store_load(record);
    uint8_t set = status >= STORE_GOOD ? record[0] : 0;
    say(FLASH_TEXT("status "), (char)('0' + (char)status));
    say(FLASH_TEXT("set "), status < STORE_GOOD ? '-' : is_whole() ? (char)('0' + set) : '?');
    for (uint8_t i = 0; i < STORE_IMAGE_SIZE; i++) {
        record[i] = (uint8_t)(set + 1u);
    }
    (void)store_save_begin();
    begun();
    while (store_busy()) {
        bool more = store_pass();
        begun();
        if (!more) {
            hal_sleep_until_wake();
        }
    }
    say(FLASH_TEXT("save "), store_failed() ? '-' : '+');
    say(FLASH_TEXT("end"), ' ');
    cli();
    sleep_enable();
    sleep_cpu();
    for (;;) {
    }
}
