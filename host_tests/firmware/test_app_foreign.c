/*
 * Fault 2, "no ADXL345 at 0x..: DEVID 0x..": its words come out after the driver has gone on to the
 * other address, and name the device that was found.
 */
#include <stdio.h>

#include "adxl345.h"
#include "adxl345_driver.h"
#include "adxl345_registers.h"
#include "support/talk.h"
#include "support/test.h"

/* of a `status`, a millisecond apart */
enum { PHASES = 61 };
enum { LOW_ID = 0xE6, HIGH_ID = 0x42 };

static const uint8_t addresses[] = { ADXL345_ADDRESS_LOW, ADXL345_ADDRESS_HIGH };
static stream_t stream;
static uint8_t real; /* address of the one ADXL345; 0: there is none */

void setUp(void)
{
    real = 0;
    stream = board_noisy_stream(300, 100.0, 1.5, 3u);
}

static uint8_t id_at(uint8_t address)
{
    return address == ADXL345_ADDRESS_LOW ? LOW_ID : HIGH_ID;
}

static uint8_t on_rx(uint8_t reg, uint8_t byte)
{
    return reg == ADXL345_DEVID && hal_host_sensor()->address != real ? id_at(hal_host_sensor()->address) : byte;
}

/* One fault was reported, and so. */
static void the_line_is(uint8_t address)
{
    char words[BOARD_NOTE_LENGTH];
    snprintf(words, sizeof words, "# fault 2: no ADXL345 at 0x%02X: DEVID 0x%02X, not 0xE5", address, id_at(address));
    TEST_ASSERT_EQUAL_size_t_MESSAGE(1, board_notes_with("# fault", 0), words);
    size_t at = 0;
    while (board_notes_with("# fault", at + 1) != 0) {
        at++;
    }
    TEST_ASSERT_EQUAL_STRING(words, board.notes[at]);
}

/* A `status` puts the line off by as long as it takes, which is several looks for the sensor. */
TEST(test_fault_2_names_the_device_that_was_found_at_every_phase)
{
    for (size_t a = 0; a < sizeof addresses; a++) {
        for (unsigned phase = 0; phase < PHASES; phase++) {
            board_start_with_rx(&stream, on_rx);
            hal_host_sensor()->address = addresses[a];
            board_run_ms(phase);
            (void)talk_typed("status", 100);
            TEST_ASSERT_EQUAL(ADXL345_FAULT_WRONG_ID, adxl345_fault());
            the_line_is(addresses[a]);
        }
    }
}

/* What is said of the device stays, whichever address is asked. */
TEST(test_the_device_stays_named_while_the_other_address_is_asked)
{
    for (size_t a = 0; a < sizeof addresses; a++) {
        unsigned asked_elsewhere = 0;
        board_start_with_rx(&stream, on_rx);
        hal_host_sensor()->address = addresses[a];
        board_run_ms(20);
        for (unsigned step = 0; step < 5000; step++) {
            board_run_ms(0.02);
            asked_elsewhere += adxl345_driver_state()->address != addresses[a];
            TEST_ASSERT_EQUAL_HEX8(addresses[a], adxl345_foreign_address());
            TEST_ASSERT_EQUAL_HEX8(id_at(addresses[a]), adxl345_foreign_id());
        }
        TEST_ASSERT_TRUE(asked_elsewhere > 0);
    }
}

/* Whoever is asked answers, for so long. */
static void both_answer_for_ms(unsigned ms)
{
    for (unsigned step = 0; step < 10 * ms; step++) {
        hal_host_sensor()->address = adxl345_driver_state()->address;
        board_run_ms(0.1);
    }
}

static void the_device_is(uint8_t address)
{
    TEST_ASSERT_EQUAL(ADXL345_FAULT_WRONG_ID, adxl345_fault());
    TEST_ASSERT_EQUAL_HEX8(address, adxl345_foreign_address());
    TEST_ASSERT_EQUAL_HEX8(id_at(address), adxl345_foreign_id());
}

/* Also while the fault lasts and a second one, that is asked before it, begins to answer. */
TEST(test_the_device_stays_named_when_another_one_answers_too)
{
    for (size_t a = 0; a < sizeof addresses; a++) {
        board_start_with_rx(&stream, on_rx);
        hal_host_sensor()->address = addresses[a];
        board_run_ms(20);
        the_device_is(addresses[a]);
        both_answer_for_ms(100);
        the_device_is(addresses[a]);
    }
}

/* Who asks for one address is told of the device that is there; both addresses again, it is still named. */
TEST(test_the_device_at_the_address_asked_for_is_named)
{
    static const char *const asked[] = { "address 53", "address 1D" };
    for (size_t a = 0; a < sizeof addresses; a++) {
        board_start_with_rx(&stream, on_rx);
        hal_host_sensor()->address = addresses[1 - a];
        board_run_ms(20);
        the_device_is(addresses[1 - a]);
        board_type(asked[a]);
        both_answer_for_ms(100);
        the_device_is(addresses[a]);
        board_type("address auto");
        both_answer_for_ms(100);
        the_device_is(addresses[a]);
    }
}

/* Whoever is asked answers, and is none: the line names the first of both with its own DEVID. */
TEST(test_fault_2_names_one_of_two_devices_with_its_own_identity)
{
    for (unsigned phase = 0; phase < PHASES; phase++) {
        board_start_with_rx(&stream, on_rx);
        for (unsigned step = 0; step < 10 * PHASES + 1000; step++) {
            hal_host_sensor()->address = adxl345_driver_state()->address;
            if (step == 10 * phase) {
                board_type("status");
            }
            board_run_ms(0.1);
        }
        the_line_is(ADXL345_ADDRESS_LOW);
    }
}

/* The sensor comes back at the one address while the line about the device at the other one, the seventh, goes out. */
TEST(test_fault_2_names_the_device_after_the_sensor_was_found)
{
    board_start_with_rx(&stream, on_rx);
    hal_host_sensor()->address = ADXL345_ADDRESS_HIGH;
    board_type("status");
    for (unsigned step = 0; board.note_count < 6; step++) {
        TEST_ASSERT_TRUE_MESSAGE(step < 1000, "no banner within 100 ms");
        board_run_ms(0.1);
    }
    TEST_ASSERT_EQUAL(ADXL345_FAULT_WRONG_ID, adxl345_fault());
    real = ADXL345_ADDRESS_LOW;
    hal_host_sensor()->address = real;
    board_run_ms(50);
    TEST_ASSERT_EQUAL(ADXL345_STREAMING, adxl345_phase());
    TEST_ASSERT_EQUAL_HEX8(ADXL345_ADDRESS_LOW, adxl345_address());
    TEST_ASSERT_EQUAL_HEX8(ADXL345_ADDRESS_HIGH, adxl345_foreign_address());
    TEST_ASSERT_EQUAL_HEX8(HIGH_ID, adxl345_foreign_id());
    board_run_ms(300);
    TEST_ASSERT_EQUAL_size_t(1, board_notes_with("# fault 2: no ADXL345 at 0x1D: DEVID 0x42", 0));
}
