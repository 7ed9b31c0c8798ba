/*
 * What the host's HAL runs on: a virtual clock, an I2C master with bit-time accuracy on the virtual ADXL345, a UART
 * line. The clock advances while main sleeps, from event to event, and by a fixed 20 us per pass of main, so a run is
 * exactly repeatable and as fast as the PC allows. For tests and for the native replay.
 */
#ifndef HAL_HOST_H
#define HAL_HOST_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "adxl345_model.h"
#include "feed.h"

#define HAL_HOST_HZ 16000000ull /* of the virtual clock: the UNO's cycles */

typedef struct {
    uint32_t time_start_us;      /* hal_time_us at start: set near 2^32 to cross the wrap */
    double ppm;                  /* error of the sensor's clock */
    void (*on_tx)(uint8_t byte); /* a byte was sent; NULL: dropped */
    void (*on_latched)(uint64_t t_us, size_t row, const int16_t lsb[3]); /* the sensor took a sample; may be NULL */
    uint8_t (*on_rx)(uint8_t reg, uint8_t byte); /* may change a byte read from a register; NULL: unchanged */
    void (*on_bus_clear)(void);  /* the bus is being cleared, interrupts on: what happens meanwhile; may be NULL */
    void (*on_stop_asked)(void); /* main asks for the last STOP: what happens just before the answer; may be NULL */
} hal_host_config_t;

/* Bus and wiring faults that a test can set at any time. */
typedef struct {
    bool scl_low;                /* held low from outside: no transfer completes */
    bool sda_low;                /* the same */
    bool stop_stuck;             /* a STOP does not complete until the pins are released */
    uint8_t hang_clocks;         /* a slave holds SDA low until it has seen this many clocks */
    bool int1_cut;               /* INT1 does not reach D2 */
    bool int1_high;              /* D2 is held high */
    uint8_t write_lost_register; /* writes to this register do not reach the sensor; 0: all do */
    bool id_wrong;               /* DEVID reads 0x00 */
    uint8_t corrupt_rx_every;    /* every Nth received UART byte has a framing error; 0 = none */
    int next_status;             /* >= 0: a later bus event reports this status instead; the sensor does not see it */
    unsigned status_skip;        /* bus events to let pass before that one */
    bool tx_stuck;               /* the UART stops sending */
    bool strap_low;              /* D4 tied to ground */
    uint8_t lap_step;            /* added to hal_time_lap at each call: main is slow */
} hal_host_faults_t;

/* A test sets the processor clock that the firmware sees (HAL_CPU_HZ); power-on sets it to HAL_HOST_HZ. */
void hal_host_set_cpu_hz(uint32_t hz);

/* The sensor, for a test to cut its supply and to read or change its registers; power-on makes it a fresh one. */
adxl345_model_t *hal_host_sensor(void);

/* The faults in force, for a test to set; power-on clears them. */
hal_host_faults_t *hal_host_faults(void);

/* Power-on of board and sensor. The stream may be NULL (no samples). */
void hal_host_begin(const hal_host_config_t *config, const stream_t *stream, bool loop);

/*
 * Resets only the MCU (time goes on, the sensor does not notice); the next firmware start sees this cause and the note
 * of the run before.
 */
void hal_host_reset_mcu(uint8_t cause);

/* A rising edge on D2 from any source; the level is that of the sensor and of hal_host_faults. */
void hal_host_drdy_edge(void);

/* Types these bytes at the current baud rate, starting immediately. */
void hal_host_type(const char *text);

/* Cycles since power-on; whether the stream is exhausted; the cycle at which the watchdog expired, 0 = never. */
uint64_t hal_host_now(void);
bool hal_host_stream_over(void);
uint64_t hal_host_watchdog_bite(void);

/* Bit-banged clocks and STOPs since power-on. */
uint32_t hal_host_hand_clocks(void);
uint32_t hal_host_hand_stops(void);

/* Virtual time in milliseconds. */
double hal_host_now_ms(void);

/* State visible from outside. */
uint32_t hal_host_baud(void);
bool hal_host_led(void);

/* The EEPROM's HAL_EEPROM_SIZE cells, 0xFF at power-on and kept across an MCU reset; how often a cell was written. */
uint8_t *hal_host_eeprom(void);
uint32_t hal_host_eeprom_writes(uint16_t address);

/*
 * What a power cut leaves in the cell being written. OLD also covers a cut just before the write, NEW one just after.
 */
typedef enum { HAL_HOST_LEFT_OLD, HAL_HOST_LEFT_NEW, HAL_HOST_LEFT_ERASED, HAL_HOST_LEFT_VALUE } hal_host_left_t;

/*
 * The supply fails during the Nth write from this call, 1 being the next (0: never), which leaves `left` in its cell;
 * value is for HAL_HOST_LEFT_VALUE. After that nothing is written and the EEPROM is not ready, until
 * hal_host_reset_mcu.
 */
void hal_host_eeprom_cut(uint32_t nth, hal_host_left_t left, uint8_t value);
bool hal_host_eeprom_was_cut(void);

/* This cell keeps its content, whatever is written; HAL_EEPROM_SIZE: none. */
void hal_host_eeprom_wear_out(uint16_t address);

#endif
