/* The PC's side of the contracts in hal: the same verbs over a virtual bus, clock and line (hal_host.h drives them). */
#ifndef HAL_PORT_H
#define HAL_PORT_H

#include <stdbool.h>
#include <stdint.h>

/* hal_irq.h */
uint8_t hal_irq_save(void);
void hal_irq_restore(uint8_t state);
void hal_irq_enable(void);

/* hal_ram.h */
#define HAL_RAM_CLEARED 0

/* hal_pointer.h */
#define HAL_POINTER(p) ((void)(p))

/* hal_i2c.h */
#define HAL_I2C_ISR()                \
    void hal_host_i2c_handler(void); \
    void hal_host_i2c_handler(void)
void hal_i2c_enable(bool fast);
void hal_i2c_disable(void);
uint8_t hal_i2c_clear(void);
void hal_i2c_start(void);
void hal_i2c_send(uint8_t byte);
void hal_i2c_receive(bool ack);
uint8_t hal_i2c_received(void);
void hal_i2c_stop(void);
void hal_i2c_release(void);
uint8_t hal_i2c_status(void);
bool hal_i2c_stop_pending(void);

/* hal_time.h */
#define HAL_CPU_HZ hal_host_cpu_hz
#define HAL_LAP_US 64u
extern uint32_t hal_host_cpu_hz;
void hal_time_init(void);
uint32_t hal_time_us(void);
uint16_t hal_time_count_isr(void);
void hal_time_stamp_isr(volatile uint32_t *t_us, uint16_t count);
void hal_wake_at(uint32_t t_us);
uint8_t hal_time_lap(void);

/* hal_drdy.h */
#define HAL_DRDY_ISR()                \
    void hal_host_drdy_handler(void); \
    void hal_host_drdy_handler(void)
void hal_drdy_enable(void);
bool hal_drdy_high(void);

/* hal_sleep.h */
void hal_wake(void);
void hal_sleep_until_wake(void);

/* hal_uart.h */
#define HAL_UART_REACHES(baud) ((baud) != 0)
void hal_uart_init(uint32_t baud);
uint8_t hal_uart_tx_room(void);
void hal_uart_tx_stage(uint8_t byte);
void hal_uart_tx_commit(void);
void hal_uart_tx_discard(void);
bool hal_uart_tx_write(const char *line, uint8_t length);
bool hal_uart_tx_idle(void);
uint8_t hal_uart_tx_sent(void);
bool hal_uart_rx(uint8_t *byte);
uint8_t hal_uart_rx_lost(void);

/* hal_watchdog.h */
void hal_watchdog_start(void);
void hal_watchdog_feed(void);
void hal_watchdog_note(uint8_t note);
uint8_t hal_watchdog_cause(void);
uint8_t hal_reset_note(void);
uint8_t hal_reset_repeats(void);
void hal_reset_settled(void);
#define hal_reset_cause() ((hal_reset_t)hal_watchdog_cause())

/* hal_eeprom.h */
bool hal_eeprom_ready(void);
uint8_t hal_eeprom_read(uint16_t address);
void hal_eeprom_write_start(uint16_t address, uint8_t value);

/* hal_strap.h */
void hal_strap_init(void);
bool hal_strap_low(void);

/* hal_led.h */
void hal_led_init(void);
void hal_led_set(bool on);

/* flash.h: program memory is ordinary memory here */
#define FLASH
#define FLASH_TEXT(words) (words)

static inline uint8_t flash_u8(const uint8_t *p)
{
    return *p;
}

static inline uint16_t flash_u16(const uint16_t *p)
{
    return *p;
}

static inline uint32_t flash_u32(const uint32_t *p)
{
    return *p;
}

static inline char flash_char(const char *p)
{
    return *p;
}

#endif
