/*
 * Runs on the ATmega328P (simavr): the parts of the HAL that the firmware does not use yet, each answered with a line
 * on the UART. Reads EEPROM byte 1023, writes its complement, waits for the write by sleeping, reads it back; sets the
 * alarm and says how late main woke, also where it had passed already; fills the transmit ring; clocks the bus by hand
 * three times and says how long it took; then sleeps with interrupts off.
 */
#include <avr/interrupt.h>
#include <avr/sleep.h>

#include "hal_eeprom.h"
#include "hal_i2c.h"
#include "hal_irq.h"
#include "hal_sleep.h"
#include "hal_time.h"
#include "hal_uart.h"
#include "hal_watchdog.h"
#include "machine.h"

enum { LAST_BYTE = 1023, CLEARS = 3 };

static void say(flash_text_t words, uint8_t value)
{
    for (char c = flash_char(words); c != '\0'; c = flash_char(++words)) {
        hal_uart_tx_stage((uint8_t)c);
    }
    hal_uart_tx_stage((uint8_t)(' '));
    for (uint8_t bit = 0x80; bit != 0; bit = (uint8_t)(bit >> 1)) {
        hal_uart_tx_stage((value & bit) ? '1' : '0');
    }
    hal_uart_tx_stage('\n');
    hal_uart_tx_commit();
}

/* How late main wakes at an alarm so far ahead, in us, saturating: from a quiet line, so that nothing else wakes it. */
static void say_alarm(uint16_t ahead_us)
{
    while (!hal_uart_tx_idle()) {
    }
    uint32_t t_us = hal_time_us() + ahead_us;
    hal_wake_at(t_us);
    while (!hal_time_reached(hal_time_us(), t_us)) {
        hal_sleep_until_wake();
    }
    uint32_t late_us = hal_time_us() - t_us;
    say(FLASH_TEXT("late"), late_us > UINT8_MAX ? UINT8_MAX : (uint8_t)late_us);
}

/* How long main sleeps at an alarm that passed so long ago, in us, saturating: it is woken at once (hal_time.h). */
static void say_passed(uint16_t ago_us)
{
    while (!hal_uart_tx_idle()) {
    }
    uint32_t begun_us = hal_time_us();
    hal_wake_at(begun_us - ago_us);
    hal_sleep_until_wake();
    uint32_t slept_us = hal_time_us() - begun_us;
    say(FLASH_TEXT("slept"), slept_us > UINT8_MAX ? UINT8_MAX : (uint8_t)slept_us);
}

/* What the bus is after the clocks by hand, and how long they took, in units of 2 us: no byte is sent meanwhile. */
static void say_clear(void)
{
    while (!hal_uart_tx_idle()) {
    }
    uint32_t begun_us = hal_time_us();
    uint8_t lines = hal_i2c_clear();
    say(FLASH_TEXT("clear"), (uint8_t)((hal_time_us() - begun_us) / 2u));
    say(FLASH_TEXT("lines"), lines);
}

/*
 * Whether a line that is a byte too long for the room is taken (2), and one that fills it (1); bytes discarded are not
 * sent.
 */
static void say_room(void)
{
    static char spaces[UINT8_MAX];
    for (uint8_t i = 0; i < UINT8_MAX; i++) {
        spaces[i] = ' ';
    }
    while (!hal_uart_tx_idle()) {
    }
    hal_uart_tx_stage('x');
    hal_uart_tx_discard();
    hal_uart_tx_stage(' ');
    uint8_t room = hal_uart_tx_room();
    bool longer = hal_uart_tx_write(spaces, (uint8_t)(room + 1u));
    bool whole = hal_uart_tx_write(spaces, room);
    while (!hal_uart_tx_idle()) {
    }
    say(FLASH_TEXT("room"), (uint8_t)(2u * longer + whole));
}

static const uint16_t passed_us[] IN_FLASH = { 0, 100, 900 };
static const uint16_t alarms_us[] IN_FLASH = { 300, 3000, 5000, 10000, 25000, 32766, 40000 };

int main(void)
{
    hal_uart_init(115200);
    hal_time_init();
    hal_irq_enable();
    uint8_t before = hal_eeprom_read(LAST_BYTE);
    say(FLASH_TEXT("before"), before);
    (void)hal_eeprom_read(LAST_BYTE - 1); /* a write goes to its own address, not to the last one read */
    hal_eeprom_write_start(LAST_BYTE, (uint8_t)~before);
    say(FLASH_TEXT("ready"), hal_eeprom_ready());
    uint32_t begun_us = hal_time_us();
    while (!hal_eeprom_ready()) {
        hal_sleep_until_wake();
    }
    say(FLASH_TEXT("ticks"), (uint8_t)((hal_time_us() - begun_us + HAL_TICK_US - 1u) / HAL_TICK_US));
    say(FLASH_TEXT("after"), hal_eeprom_read(LAST_BYTE));
    for (uint8_t i = 0; i < sizeof alarms_us / sizeof alarms_us[0]; i++) {
        say_alarm(flash_u16(&alarms_us[i]));
    }
    for (uint8_t i = 0; i < sizeof passed_us / sizeof passed_us[0]; i++) {
        say_passed(flash_u16(&passed_us[i]));
    }
    say_room();
    for (uint8_t i = 0; i < CLEARS; i++) {
        say_clear();
    }
    while (!hal_uart_tx_idle()) {
        hal_sleep_until_wake();
    }
    cli();
    sleep_enable();
    sleep_cpu();
    for (;;) {
    }
}
