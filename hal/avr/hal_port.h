/*
 * The ATmega328P's side of the contracts in hal: every verb is one or two register accesses, inlined at the call.
 * Register names and bits: ATmega328P data sheet, chapter of each peripheral.
 */
#ifndef HAL_PORT_H
#define HAL_PORT_H

#include <avr/interrupt.h>
#include <avr/io.h>
#include <avr/pgmspace.h>
#include <avr/sleep.h>
#include <avr/wdt.h>
#include <stdbool.h>
#include <stdint.h>

/* hal_irq.h */
static inline uint8_t hal_irq_save(void)
{
    uint8_t state = SREG;
    cli();
    return state;
}

static inline void hal_irq_restore(uint8_t state)
{
    __asm__ volatile("" ::: "memory");
    SREG = state;
}

static inline void hal_irq_enable(void)
{
    sei();
}

/* hal_ram.h */
#define HAL_RAM_CLEARED 1

/* hal_pointer.h */
#define HAL_POINTER(p) __asm__("" : "+b"(p))

/*
 * The clock. Timer1 runs at F_CPU / 8 and its counts must be whole microseconds or halves, which leaves two clocks:
 * 16 MHz (UNO, Nano, Pro Mini 5 V) and 8 MHz (Pro Mini 3.3 V).
 */
#if F_CPU != 16000000 && F_CPU != 8000000
#error "F_CPU: this firmware knows processors of 16 MHz and of 8 MHz"
#endif

/*
 * hal_i2c.h: SCL is F_CPU / (16 + 2 TWBR). A clock of 2.75 us gives 363.6 kHz, one of 2.5 us 400 kHz: TWBR 14 and 12 at
 * 16 MHz, 3 and 2 at 8 MHz. The internal pull-ups stay off (5 V).
 */
#define HAL_I2C_TWBR(clock_ns) ((uint8_t)((F_CPU / 1000000 * (clock_ns) / 1000 - 16) / 2))
#define HAL_I2C_ISR() ISR(TWI_vect)

enum { HAL_I2C_GO = _BV(TWINT) | _BV(TWEN) | _BV(TWIE) };

static inline void hal_i2c_enable(bool fast)
{
    TWSR = 0;
    TWBR = fast ? HAL_I2C_TWBR(2500) : HAL_I2C_TWBR(2750);
    TWCR = _BV(TWEN);
}

static inline void hal_i2c_disable(void)
{
    TWCR = 0;
}

/* SDA is PC4, SCL PC5. Open drain by the direction register, the port bits stay 0: never drives high. */
uint8_t hal_i2c_clear(void);

static inline void hal_i2c_start(void)
{
    __asm__ volatile("" ::: "memory"); /* what the handler is to find is written before */
    TWCR = HAL_I2C_GO | _BV(TWSTA);
}

static inline void hal_i2c_send(uint8_t byte)
{
    TWDR = byte;
    TWCR = HAL_I2C_GO;
}

static inline void hal_i2c_receive(bool ack)
{
    TWCR = ack ? (HAL_I2C_GO | _BV(TWEA)) : HAL_I2C_GO;
}

static inline uint8_t hal_i2c_received(void)
{
    return TWDR;
}

static inline void hal_i2c_stop(void)
{
    TWCR = _BV(TWINT) | _BV(TWEN) | _BV(TWSTO);
}

static inline void hal_i2c_release(void)
{
    TWCR = _BV(TWINT) | _BV(TWEN);
}

static inline uint8_t hal_i2c_status(void)
{
    return TWSR & 0xF8u;
}

static inline bool hal_i2c_stop_pending(void)
{
    return (TWCR & _BV(TWSTO)) != 0;
}

/* hal_time.h */
#ifndef HAL_CPU_HZ /* a test image tells a slower one */
#define HAL_CPU_HZ F_CPU
#endif
enum { HAL_COUNTS_PER_US = F_CPU / 8000000 };        /* Timer1 */
#define HAL_LAP_US ((uint8_t)(1024000000ul / F_CPU)) /* Timer2 at F_CPU / 1024 */
void hal_time_init(void);
uint32_t hal_time_us(void);
void hal_wake_at(uint32_t t_us);

extern volatile uint32_t hal_tick_us;    /* at the last tick of Timer1 */
extern volatile uint16_t hal_tick_count; /* its counter then */

static inline __attribute__((always_inline)) uint16_t hal_time_count_isr(void)
{
    return TCNT1;
}

/*
 * *t_us = hal_tick_us + (uint16_t)(count - hal_tick_count) / HAL_COUNTS_PER_US; a late tick only makes the difference
 * longer: right for 32 ms. By hand, a byte at a time: the compiler would have the handler save four registers more, 16
 * cycles. What lies between the additions leaves the carry as it is.
 */
#if F_CPU == 16000000
#define HAL_COUNTS_TO_US "lsr %B[count]\n\tror %A[count]\n\t"
#else
#define HAL_COUNTS_TO_US ""
#endif
static inline __attribute__((always_inline)) void hal_time_stamp_isr(volatile uint32_t *t_us, uint16_t count)
{
    uint8_t byte;
    __asm__ volatile("lds %[byte], %[tick]\n\t"
                     "sub %A[count], %[byte]\n\t"
                     "lds %[byte], %[tick]+1\n\t"
                     "sbc %B[count], %[byte]\n\t" HAL_COUNTS_TO_US "lds %[byte], %[us]\n\t"
                     "add %A[count], %[byte]\n\t"
                     "st %a[to], %A[count]\n\t"
                     "lds %[byte], %[us]+1\n\t"
                     "adc %B[count], %[byte]\n\t"
                     "std %a[to]+1, %B[count]\n\t"
                     "ldi %B[count], 0\n\t"
                     "lds %[byte], %[us]+2\n\t"
                     "adc %[byte], %B[count]\n\t"
                     "std %a[to]+2, %[byte]\n\t"
                     "lds %[byte], %[us]+3\n\t"
                     "adc %[byte], %B[count]\n\t"
                     "std %a[to]+3, %[byte]"
                     : [count] "+d"(count), [byte] "=&r"(byte)
                     : [to] "b"(t_us), [us] "i"(&hal_tick_us), [tick] "i"(&hal_tick_count)
                     : "memory");
}

/* Timer2 */
static inline uint8_t hal_time_lap(void)
{
    return TCNT2;
}

/* hal_drdy.h: INT0 is pin PD2 = D2 */
#define HAL_DRDY_ISR() ISR(INT0_vect)

static inline void hal_drdy_enable(void)
{
    EICRA = _BV(ISC01) | _BV(ISC00);
    EIFR = _BV(INTF0);
    EIMSK = _BV(INT0);
}

static inline __attribute__((always_inline)) bool hal_drdy_high(void) /* a handler asks */
{
    return (PIND & _BV(PD2)) != 0;
}

/* hal_sleep.h: GPIOR0 is one instruction to set and one cycle to test, so it holds the wake flag */
static inline __attribute__((always_inline)) void hal_wake(void)
{
    GPIOR0 |= 1;
}

void hal_sleep_until_wake(void);

/*
 * hal_uart.h: with 8 clocks a sample a frame is right within 2.2 % (115200 at 16 MHz and 57600 at 8 MHz are 2.12 % too
 * fast), and a byte must last 160 cycles, because its interrupts take most of them. For #if.
 */
#define HAL_UART_DIVISOR(baud) ((F_CPU / 8 + (baud) / 2) / (baud))
#define HAL_UART_REACHES(baud)                                                           \
    (F_CPU / 16 >= (baud) && F_CPU / 8 * 1000 <= HAL_UART_DIVISOR(baud) * (baud)*1022 && \
     F_CPU / 8 * 1000 >= HAL_UART_DIVISOR(baud) * (baud)*978)
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
void hal_watchdog_tick_isr(void);
#define hal_reset_cause() ((hal_reset_t)hal_watchdog_cause())

/* hal_eeprom.h */
static inline bool hal_eeprom_ready(void)
{
    return (EECR & _BV(EEPE)) == 0;
}

static inline uint8_t hal_eeprom_read(uint16_t address)
{
    EEAR = address;
    EECR |= _BV(EERE);
    return EEDR;
}

static inline void hal_eeprom_write_start(uint16_t address, uint8_t value)
{
    EEAR = address;
    EEDR = value;
    uint8_t state = hal_irq_save();
    EECR |= _BV(EEMPE);
    EECR |= _BV(EEPE);
    hal_irq_restore(state);
}

/* hal_led.h: D13 is PB5 */
static inline void hal_led_init(void)
{
    DDRB |= _BV(PB5);
}

static inline void hal_led_set(bool on)
{
    if (on) {
        PORTB |= _BV(PB5);
    } else {
        PORTB &= (uint8_t)~_BV(PB5);
    }
}

/* hal_strap.h: D4 is PD4 */
static inline void hal_strap_init(void)
{
    PORTD |= _BV(PD4);
}

static inline bool hal_strap_low(void)
{
    return (PIND & _BV(PD4)) == 0;
}

/* flash.h */
#define FLASH PROGMEM
#define FLASH_TEXT(words) PSTR(words)

static inline uint8_t flash_u8(const uint8_t *p)
{
    return pgm_read_byte(p);
}

static inline uint16_t flash_u16(const uint16_t *p)
{
    return pgm_read_word(p);
}

static inline uint32_t flash_u32(const uint32_t *p)
{
    return pgm_read_dword(p);
}

static inline char flash_char(const char *p)
{
    return (char)pgm_read_byte(p);
}

#endif
