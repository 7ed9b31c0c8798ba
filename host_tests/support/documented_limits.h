/*
 * The limits that pages promise, a row each: its name, its value, PAGE: the words that promise it, FILE: the product's
 * text that holds it, TEST: the function that tries both sides. Several of a kind stand with ` | ` between them. {} is
 * the value, {word} and {nth} the same in words, any other {...} an expression of it, v. test_limits.py reads the rows
 * and holds pages and product to them; the tests take the numbers from here.
 */
#ifndef DOCUMENTED_LIMITS_H
#define DOCUMENTED_LIMITS_H

#define LIMITS(X)                                                                                                      \
    X(CHARACTER_MAX, 126,                                                                                              \
      "docs/protocol.md: control characters, or bytes above {}:", "firmware/console/commands.c: byte > '{chr(v)}'",    \
      "test_app_bounds: test_every_other_byte_in_a_line_is_refused_as_such")                                           \
    X(LINE_MAX, 40, "docs/protocol.md: at most {} characters, upper | docs/protocol.md: more than {} characters |",    \
      "firmware/console/commands.h: COMMANDS_LINE_MAX {}u",                                                            \
      "test_app_bounds: test_a_line_has_so_many_characters_and_no_more")                                               \
    X(EVERY_MAX, 10000, "docs/protocol.md: 1 to {}: one row for every N samples",                                      \
      "firmware/settings/settings.h: SETTINGS_EVERY_MAX {}u",                                                          \
      "test_settings_ranges: test_pages_have_the_ranges_of_the_table")                                                 \
    X(OFFSET_MAX_LSB, 80, "docs/protocol.md: LSB at 0 g: -{} to {}, in steps",                                         \
      "lib/tilt/src/calibration.h: CALIBRATION_OFFSET_MAX_LSB_Q4 {v * 16}",                                            \
      "test_settings_ranges: test_pages_have_the_ranges_of_the_table")                                                 \
    X(SCALE_MIN_LSB, 200, "docs/protocol.md: LSB per g: {} to ",                                                       \
      "lib/tilt/src/calibration.h: CALIBRATION_SCALE_UQ6({}U)",                                                        \
      "test_settings_ranges: test_pages_have_the_ranges_of_the_table")                                                 \
    X(SCALE_MAX_LSB, 330, "docs/protocol.md: to {}, in steps of 1/64",                                                 \
      "lib/tilt/src/calibration.h: CALIBRATION_SCALE_UQ6({}U)",                                                        \
      "test_settings_ranges: test_pages_have_the_ranges_of_the_table")                                                 \
    X(HELD_S, 2, "docs/protocol.md: csv rows are held for {} s, | docs/faults.md: held for {} s after a long answer",  \
      "firmware/output/rows.c: HELD_TIMES = {-(-v * 1000000 >> 16)} ",                                                 \
      "test_app_reading: test_rows_are_held_to_the_nearest_step")                                                      \
    X(WARM_ROWS, 5, "docs/protocol.md: {word} rows are marked warming up",                                             \
      "firmware/path/pipeline.c: WARM_ROWS = {} ", "test_app: test_first_five_rows_warm_up")                           \
    X(REST_READINGS, 256, "docs/protocol.md: running: {} readings,", "lib/tilt/src/rest.h: REST_SAMPLES {}U",          \
      "test_rest: test_it_is_full_with_256_readings")                                                                  \
    X(REST_VARIANCE_LSB2, 125, "docs/protocol.md: a variance below {} LSB^2 at 100 Hz",                                \
      "lib/tilt/src/rest.c: variance_lsb2 >= rate_dhz >> {(1000 // v).bit_length() - 1}",                              \
      "test_rest: test_the_limits_of_the_variance")                                                                    \
    X(REST_DRIFT_LSB, 2, "docs/protocol.md: the means of both halves within {} LSB",                                   \
      "lib/tilt/src/rest.c: DRIFT_LSB = {} * HALF ",                                                                   \
      "test_rest: test_the_limit_of_the_drift_to_one_lsb_of_one_reading")                                              \
    X(MEASURE_MINUTES, 2,                                                                                              \
      "docs/protocol.md: or {word} minutes have passed | docs/protocol.md: as do {word} minutes without",              \
      "firmware/control/measure.c: SECONDS_MAX = {v * 60} ",                                                           \
      "test_app_measure: test_no_measurement_lasts_longer_than_two_minutes")                                           \
    X(CAL6_EIGHTHS, 8, "docs/protocol.md: more than {v - 1}/{} of the first",                                          \
      "firmware/control/calibrate.c: limit_q4 >> {v.bit_length() - 1})",                                               \
      "test_app_calibrate: test_seven_eighths_across_is_the_last_that_is_a_position")                                  \
    X(ROW_BYTES, 72, "docs/protocol.md: must carry {} bytes a row",                                                    \
      "firmware/settings/settings.h: SETTINGS_ROW_MAX {}u", "test_app: test_every_follows_what_the_line_carries")      \
    X(READ_LATE_US, 2000, "docs/protocol.md: by half a period and {v // 1000} ms after it was due",                    \
      "firmware/app/app.c: READ_LATE_US {}u", "test_app_bounds: test_a_predicted_row_waits_for_a_sample_on_its_way")   \
    X(HOLD_MS, 100, "docs/protocol.md: (for {} ms, its rate",                                                          \
      "firmware/path/silence.c: HOLD_QUARTERS = {v // 25}, | lib/filters/src/filter.h: FILTER_HOLD_MS {}",             \
      "test_coast: test_rate_is_halved_every_25_ms_and_then_held")                                                     \
    X(DAMP_MS, 25, "docs/protocol.md: its rate halved every {} ms",                                                    \
      "firmware/path/silence.c: HALF_QUARTER_DHZ = {v * 8},",                                                          \
      "test_coast: test_rate_is_halved_every_25_ms_and_then_held")                                                     \
    X(LONG_S, 1, "docs/protocol.md: after {} s a row each 100 ms)",                                                    \
      "firmware/path/silence.c: LONG_QUARTERS = {v * 40} ", "test_coast: test_rows_of_missing_samples")                \
    X(LONG_STEP_MS, 100, "docs/protocol.md: s a row each {} ms)",                                                      \
      "firmware/path/coast.c: LONG_STEP_US UINT32_C({v * 1000})", "test_coast: test_rows_of_missing_samples")          \
    X(MISSING_FAULT, 3, "docs/protocol.md: the {nth} sample missing in a row",                                         \
      "firmware/path/silence.h: SILENCE_FAULT_FROM = {} ", "test_coast: test_rows_of_missing_samples")                 \
    X(G_LSB, 256,                                                                                                      \
      "docs/protocol.md: (16 g: -{16 * v}, {16 * v - 1}; 8 g: -{8 * v}, {8 * v - 1}; 4 g: -{4 * v}, {4 * v - 1}; 2 "   \
      "g: -{2 * v}, {2 * v - 1})",                                                                                     \
      "firmware/path/pipeline.c: range_g * {}U - 1U",                                                                  \
      "test_row_flags: test_clipped_at_the_rails_of_the_range_in_force")                                               \
    X(STUCK_SAMPLES, 10,                                                                                               \
      "docs/protocol.md: at least the {nth} in a row | docs/faults.md: values {word} times in a row",                  \
      "lib/adxl345/src/adxl345_integrity.h: ADXL345_STUCK_REPEATS {v - 1}u",                                           \
      "test_integrity: test_the_tenth_equal_reading_is_stuck")                                                         \
    X(GRAVITY_PERCENT, 15,                                                                                             \
      "docs/protocol.md: lies outside {1 - v / 100:g}..{1 + v / 100:g} g | docs/protocol.md: level; length {1 - v / "  \
      "100:g} "                                                                                                        \
      "to {1 + v / 100:g} |",                                                                                          \
      "lib/tilt/src/tilt.c: lowest_q12 = {ceil(((100 - v) * 163.84) ** 2)}UL | lib/tilt/src/tilt.c: highest_q12 = "    \
      "{int(((100 + v) * 163.84) ** 2)}UL",                                                                            \
      "test_tilt_steps: test_the_limits_of_gravity_to_the_last_unit")                                                  \
    X(ROLL_MIN_LSB, 4, "docs/protocol.md: (y, z) below {} LSB", "lib/tilt/src/tilt.h: TILT_ROLL_MIN_Q8 {v * 256}U",    \
      "test_tilt_steps: test_the_limit_of_roll")                                                                       \
    X(REST_CYCLES, 7300, "docs/protocol.md: the period less {format(v, ',')} cycles",                                  \
      "firmware/settings/settings.h: SETTINGS_REST_CYCLES {}u",                                                        \
      "test_app_sample_time: test_every_filter_fits_every_rate_of_this_board_but_the_slowest_800_hz")                  \
    X(ROW_CYCLES, 11700, "docs/protocol.md: for it: {format(v, ',')} cycles a row",                                    \
      "firmware/settings/settings.h: SETTINGS_ROW_CYCLES {}u",                                                         \
      "test_app_sample_time: test_every_follows_what_the_filter_leaves_time_for")                                      \
    X(FOLLOW_PART, 128, "docs/protocol.md: by more than 1/{} and 0.1 Hz",                                              \
      "firmware/path/pipeline.c: true_dhz >> {v.bit_length() - 1}) + 1u",                                              \
      "test_true_rate: test_the_least_that_is_followed_at_each_rate")                                                  \
    X(FOLLOW_S, 5, "docs/protocol.md: for {} seconds in a row", "firmware/path/pipeline.c: CALLS_OFF = {},",           \
      "test_true_rate: test_the_sixth_second_off_hands_the_rate_over_once")                                            \
    X(STILL_LSB_Q1, 9, "docs/protocol.md: within {v / 2} LSB (one degree)",                                            \
      "firmware/path/pipeline.c: STILL_LSB_Q2 = {v * 2} ", "test_true_rate: test_the_most_that_is_standing_still")     \
    X(OUTAGE_S, 60, "docs/faults.md: from {} s on in whole seconds", "firmware/control/sensor_watch.c: (ms < {}000u)", \
      "test_app_bounds: test_an_outage_from_a_minute_on_is_in_whole_seconds")                                          \
    X(LED_MS, 65, "docs/faults.md: that many flashes of {} ms",                                                        \
      "firmware/control/sensor_watch.c: FLASH_SHIFT {(v * 1000).bit_length()}",                                        \
      "test_app_told: test_led_flashes_by_what_to_look_at")                                                            \
    X(TRIES, 3, "docs/faults.md: transfers fail {word} times in a row",                                                \
      "lib/adxl345/src/adxl345_driver.h: TRIES = {} ", "test_driver_pace: test_three_failed_bursts_are_a_fault")       \
    X(BACK_OFF_MIN_MS, 5, "docs/faults.md: looked for again after {} ms,",                                             \
      "lib/adxl345/src/adxl345_driver.h: BACK_OFF_MIN = {v * 2},",                                                     \
      "test_driver_pace: test_tries_again_at_a_pause_that_doubles_to_25_ms")                                           \
    X(BACK_OFF_MAX_MS, 25, "docs/faults.md: up to {} ms.",                                                             \
      "lib/adxl345/src/adxl345_driver.h: BACK_OFF_MAX = {v * 2},",                                                     \
      "test_driver_pace: test_tries_again_at_a_pause_that_doubles_to_25_ms")                                           \
    X(RESTS, 40, "docs/faults.md: tried {} times more", "lib/adxl345/src/adxl345.c: RESTS = {} ",                      \
      "test_driver_pace: test_a_stop_is_tried_again_for_a_second")                                                     \
    X(TORN, 3, "docs/faults.md: {word} readings in a row were none of this sensor",                                    \
      "lib/adxl345/src/adxl345_integrity.c: RUN_LIMIT = {},", "test_integrity: test_torn_readings_stay_torn")          \
    X(EMPTY, 3, "lib/adxl345/src/adxl345_integrity.h: INT1 was high without a sample {word} times",                    \
      "lib/adxl345/src/adxl345_integrity.c: RUN_LIMIT = {},",                                                          \
      "test_integrity: test_the_third_empty_reading_is_of_an_int1_that_is_stuck")                                      \
    X(TRUSTED, 32, "lib/adxl345/src/adxl345_integrity.h: until {} good",                                               \
      "lib/adxl345/src/adxl345_integrity.c: RUN_EMPTY = RUN_LIMIT + {v - 1} ",                                         \
      "test_integrity: test_an_int1_that_was_stuck_is_trusted_anew")                                                   \
    X(SENSOR_DEPTH, 33, "docs/faults.md: FIFO that had filled up ({} samples)",                                        \
      "lib/adxl345/src/adxl345_registers.h: ADXL345_DEPTH {}u",                                                        \
      "test_driver_stamps: test_no_sample_waits_longer_than_the_sensor_is_deep")                                       \
    X(PERIOD_STEPS, 16,                                                                                                \
      "docs/faults.md: the mean of {} samples in a row | docs/protocol.md: of {} samples read on time",                \
      "lib/adxl345/src/adxl345_period.c: STEPS = {} ", "test_driver_period: test_sixteen_steps_are_a_measurement")     \
    X(JUMPS, 8, "docs/faults.md: begins with the {nth} jump in close order",                                           \
      "lib/adxl345/src/adxl345_watch.c: LIMIT = {v * 16},",                                                            \
      "test_watch: test_the_eighth_jump_is_told_and_quiet_ends_it")                                                    \
    X(JUMP_SHARE, 16, "docs/faults.md: more than one in {word} samples",                                               \
      "lib/adxl345/src/adxl345_watch.c: RAISE = {},", "test_watch: test_one_jump_in_sixteen_is_the_limit")             \
    X(JUMPS_END, 255, "docs/faults.md: ends {} samples after the last jump",                                           \
      "lib/adxl345/src/adxl345_watch.c: SCORE_MAX = {} ",                                                              \
      "test_watch: test_the_eighth_jump_is_told_and_quiet_ends_it")                                                    \
    X(DOUBLE_MIN_LSB, 64,                                                                                              \
      "docs/faults.md: changes by {v - (v >> 4)} LSB or more | docs/faults.md: values below {} LSB do not count",      \
      "lib/adxl345/src/adxl345_watch.c: MIN_LSB = {},", "test_watch: test_what_a_doubling_is")                         \
    X(GARBLED, 16, "docs/faults.md: After {word} of the faults",                                                       \
      "lib/adxl345/src/adxl345_driver.h: GARBLED_SLOW = {}, ",                                                         \
      "test_driver_i2c: test_the_clock_changes_after_sixteen_faults")                                                  \
    X(EDGES, 9, "docs/faults.md: The {nth} switches the input | docs/faults.md: before the {nth} comes",               \
      "hal/hal_drdy.h: HAL_DRDY_EDGES = {},", "test_driver_int1: test_nine_edges_in_a_tick_flicker")                   \
    X(EDGES_AGAIN, 8, "docs/faults.md: they are fewer than {word}", "hal/hal_drdy.h: HAL_DRDY_EDGES_AGAIN = {},",      \
      "test_driver_int1: test_eight_edges_are_too_many_to_be_believed_again")                                          \
    X(DEAF_MS, 250, "docs/faults.md: After {} ms the edges",                                                           \
      "hal/hal_drdy.h: HAL_DRDY_DEAF_TICKS = {1 - (-v * 1000 // 8192)} ",                                              \
      "test_driver_int1: test_nine_edges_in_a_tick_flicker")                                                           \
    X(NO_GRAVITY_S, 10, "docs/faults.md: for {word} seconds at rest", "firmware/path/gravity.c: ABSENT_S = {} ",       \
      "test_gravity: test_ten_seconds_at_rest_and_the_first_within")                                                   \
    X(GRAVITY_LEAST_LSB, 157, "docs/faults.md: outside {} to", "firmware/path/gravity.c: LEAST = {v * v >> 12},",      \
      "test_gravity: test_the_limits_on_every_axis")                                                                   \
    X(GRAVITY_MOST_LSB, 356, "docs/faults.md: to {} LSB (0.61 to 1.39 g",                                              \
      "firmware/path/gravity.c: BEYOND = {(v + 1) * (v + 1) >> 12} ", "test_gravity: test_the_limits_on_every_axis")   \
    X(WATCHDOG_MS, 250, "docs/faults.md: did not come by within {} ms",                                                \
      "hal/hal_watchdog.h: HAL_WATCHDOG_MS {}u | hal/avr/hal_watchdog.c: WDTO_{}MS",                                   \
      "test_health: test_a_driver_that_nobody_polls_is_not_healthy")                                                   \
    X(GRACE_MS, 20, "docs/faults.md: sampling ({} ms after", "firmware/base/health.c: POLL_GRACE_US {v * 1000}ul",     \
      "test_health: test_a_driver_past_its_deadline_has_20_ms_of_grace")                                               \
    X(RESETS_TO_SAFE, 3, "docs/faults.md: the {nth} watchdog reset in a row",                                          \
      "firmware/base/health.c: RESETS_TO_SAFE = {} ",                                                                  \
      "test_app_bounds: test_the_third_reset_in_a_row_brings_safe_settings")                                           \
    X(SETTLED_S, 10, "docs/faults.md: each within {} s of its start | docs/faults.md: After {} s without a reset",     \
      "firmware/app/app.c: SETTLED_S = {},", "test_app_bounds: test_a_run_of_ten_seconds_counts_as_lasting")

#define LIMIT_OF_ROW(name, value, ...) LIMIT_##name = (value),
enum { LIMITS(LIMIT_OF_ROW) };

#endif
