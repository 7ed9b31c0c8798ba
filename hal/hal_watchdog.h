/*
 * Watchdog (250 ms, reset only) and the cause of the last reset.
 *
 * The UNO's bootloader clears MCUSR before the application runs, so the cause comes from a breadcrumb in RAM that no
 * start-up code clears: a mark, the time since the last feed, a note from the application, and the number of watchdog
 * resets in a row. After a bootloader, a supply dip that left the RAM intact cannot be distinguished from the reset
 * button.
 */
#ifndef HAL_WATCHDOG_H
#define HAL_WATCHDOG_H

#include <stdbool.h>
#include <stdint.h>

#define HAL_WATCHDOG_MS 250u

typedef enum { HAL_RESET_POWER_ON, HAL_RESET_EXTERNAL, HAL_RESET_BROWN_OUT, HAL_RESET_WATCHDOG } hal_reset_t;

/* Starts the watchdog; before that the cause is not known. Main, once. */
void hal_watchdog_start(void);

/* Main, in one place only. */
void hal_watchdog_feed(void);

/* Records what main is waiting for; survives the reset. Main. */
void hal_watchdog_note(uint8_t note);

/* The cause of the reset that started this run. Any context. */
hal_reset_t hal_reset_cause(void);

/* The note left by the previous run; 0 after power-on. Any context. */
uint8_t hal_reset_note(void);

/*
 * Watchdog resets in a row, including the one that started this run; saturates; 0 after any other cause. Any context.
 */
uint8_t hal_reset_repeats(void);

/* This run is stable: the next watchdog reset counts as the first. Main. */
void hal_reset_settled(void);

/* MCUSR bits (data sheet p. 54). */
enum { HAL_MCUSR_POWER_ON = 0x01, HAL_MCUSR_EXTERNAL = 0x02, HAL_MCUSR_BROWN_OUT = 0x04, HAL_MCUSR_WATCHDOG = 0x08 };

/*
 * The cause from what is left: MCUSR (0 if a bootloader cleared it), whether the breadcrumb's mark is intact (RAM kept
 * its contents: no power loss) and the ticks of HAL_TICK_US since the last feed. Close to 250 ms without a feed means
 * the watchdog.
 */
static inline hal_reset_t hal_reset_classify(uint8_t mcusr, bool mark_intact, uint8_t unfed_ticks)
{
    if (mcusr & HAL_MCUSR_POWER_ON) {
        return HAL_RESET_POWER_ON;
    }
    if (mcusr & HAL_MCUSR_BROWN_OUT) {
        return HAL_RESET_BROWN_OUT;
    }
    if (mcusr & HAL_MCUSR_WATCHDOG) {
        return HAL_RESET_WATCHDOG;
    }
    if (mcusr & HAL_MCUSR_EXTERNAL) {
        return HAL_RESET_EXTERNAL;
    }
    if (!mark_intact) {
        return HAL_RESET_POWER_ON;
    }
    return unfed_ticks >= 25u ? HAL_RESET_WATCHDOG : HAL_RESET_EXTERNAL;
}

/* Watchdog resets in a row, from the cause of this start and the breadcrumb's previous count. */
static inline uint8_t hal_reset_count(hal_reset_t cause, bool mark_intact, uint8_t before)
{
    if (cause != HAL_RESET_WATCHDOG) {
        return 0;
    }
    if (!mark_intact) {
        return 1;
    }
    return before == UINT8_MAX ? before : (uint8_t)(before + 1u);
}

#endif
