/*
 * Runs on the ATmega328P (simavr): cycles of each filter update, the noise estimate and the angles, call included, over 2000
 * samples of a moving axis with noise and 15 % outliers. One line each on the UART: name, least, mean, most; then it sleeps
 * with interrupts off.
 */
#include <avr/interrupt.h>
#include <avr/io.h>
#include <avr/pgmspace.h>
#include <avr/sleep.h>
#include <stdbool.h>
#include <stdint.h>

#include "kf.h"
#include "noise.h"
#include "sprf.h"
#include "tilt.h"

enum { SAMPLES = 2000 };

static void put(char c)
{
    while ((UCSR0A & _BV(UDRE0)) == 0) {
    }
    UDR0 = (uint8_t)c;
}

static void put_number(uint16_t value)
{
    char digits[5];
    uint8_t count = 0;
    do {
        digits[count++] = (char)('0' + (char)(value % 10u));
        value /= 10u;
    } while (value != 0);
    put(' ');
    while (count != 0) {
        put(digits[--count]);
    }
}

static uint32_t random_state = 1;

static int16_t uniform(uint8_t bits)
{
    random_state = random_state * 1664525u + 1013904223u;
    return (int16_t)((int16_t)(random_state >> (32u - bits)) - (int16_t)(1u << (bits - 1u)));
}

/* A triangle of 128 LSB in 10 s, noise of about 4 LSB, every seventh sample or so an outlier. */
static int16_t sample(uint16_t n)
{
    uint16_t phase = n % 1000u;
    int16_t motion = (int16_t)((phase < 500u ? phase : 1000u - phase) >> 2);
    bool outlier = (uint8_t)uniform(8) < 37u;
    return (int16_t)(motion + uniform(4) + (outlier ? uniform(8) : 0));
}

static kf_t kf;
static sprf_t sprf;
static noise_t noise;
static tilt_t tilt;
static volatile int32_t sink;

static void __attribute__((noinline)) run_nothing(int16_t z)
{
    sink = z;
}

static void __attribute__((noinline)) run_kf(int16_t z)
{
    sink = kf_update(&kf, z);
}

static void __attribute__((noinline)) run_sprf(int16_t z)
{
    sink = sprf_update(&sprf, z);
}

static void __attribute__((noinline)) run_noise(int16_t z)
{
    sink = noise_update(&noise, z);
}

static void __attribute__((noinline)) run_angles(int16_t z)
{
    tilt_angles(&tilt, (int32_t)z * 256, (int32_t)z * 640 - 7, 40000);
}

/* Timer 1 counts cycles; what an empty step costs is taken off. */
static void measure(const char *flash_name, void (*step)(int16_t), uint16_t overhead)
{
    uint16_t least = UINT16_MAX;
    uint16_t most = 0;
    uint32_t sum = 0;
    for (uint16_t n = 0; n < SAMPLES; n++) {
        int16_t z = sample(n);
        TCNT1 = 0;
        step(z);
        uint16_t cycles = (uint16_t)(TCNT1 - overhead);
        least = cycles < least ? cycles : least;
        most = cycles > most ? cycles : most;
        sum += cycles;
    }
    for (char c = (char)pgm_read_byte(flash_name); c != '\0'; c = (char)pgm_read_byte(++flash_name)) {
        put(c);
    }
    put_number(least);
    put_number((uint16_t)(sum / SAMPLES));
    put_number(most);
    put('\n');
}

static uint16_t overhead_of(void (*step)(int16_t))
{
    TCNT1 = 0;
    step(1);
    return TCNT1;
}

int main(void)
{
    kf_config_t kf_config;
    sprf_config_t sprf_config;
    kf_defaults(&kf_config, 1000);
    sprf_defaults(&sprf_config, 1000);
    kf_config.r_lsb2_q8 = 20u * 256u;
    sprf_config.r_lsb2_q8 = 20u * 256u;
    (void)kf_init(&kf, &kf_config);
    (void)sprf_init(&sprf, &sprf_config);
    noise_init(&noise, 1000, false);
    UCSR0A = _BV(U2X0);
    UBRR0 = 16;
    UCSR0B = _BV(TXEN0);
    TCCR1B = _BV(CS10);
    uint16_t overhead = overhead_of(run_nothing);
    measure(PSTR("kf"), run_kf, overhead);
    measure(PSTR("sprf"), run_sprf, overhead);
    measure(PSTR("noise"), run_noise, overhead);
    measure(PSTR("angles"), run_angles, overhead);
    while ((UCSR0A & _BV(UDRE0)) == 0) {
    }
    cli();
    sleep_enable();
    sleep_cpu();
    for (;;) {
    }
}
