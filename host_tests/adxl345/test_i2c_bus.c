/*
 * The transfer state machine alone, on a bus that answers what the test wants: every one of the 256 statuses in place
 * of the right one, at every step of the transfers that the driver makes (and of longer ones).
 */
#include <string.h>

#include "hal_i2c.h"
#include "support/test.h"

/* The state machine below talks to these instead of the virtual bus. */
#define hal_i2c_start spy_start
#define hal_i2c_send spy_send
#define hal_i2c_receive spy_receive
#define hal_i2c_received spy_received
#define hal_i2c_stop spy_stop
#define hal_i2c_release spy_release
#define hal_i2c_disable spy_disable
#define hal_i2c_status spy_status
#define hal_i2c_stop_pending() false

enum { ADDRESS = 0x53 * 2, LONGEST_READ = 10, STEPS_MAX = 40, CANARY = 0xC5 };

typedef enum { NOTHING, START, SEND, RECEIVE_ACK, RECEIVE_NACK, STOP, RELEASE, DISABLE } command_t;

static command_t command; /* the last one, and how many there were in all */
static unsigned commands;
static uint8_t sent;
static uint8_t bus_status;
static uint8_t next_byte;

/* The first byte that is read has I2C_BUS_MORE, those after it follow one by one. */
enum { FIRST_READ = 0x81 };

static void give(command_t what)
{
    command = what;
    commands++;
}

static void spy_start(void)
{
    give(START);
}

static void spy_send(uint8_t byte)
{
    sent = byte;
    give(SEND);
}

static void spy_receive(bool ack)
{
    give(ack ? RECEIVE_ACK : RECEIVE_NACK);
}

static uint8_t spy_received(void)
{
    return next_byte++;
}

static void spy_stop(void)
{
    give(STOP);
}

static void spy_release(void)
{
    give(RELEASE);
}

static void spy_disable(void)
{
    give(DISABLE);
}

static uint8_t spy_status(void)
{
    return bus_status;
}

#include "i2c_bus.h"

_Static_assert(I2C_BUS_RX_MAX == LONGEST_READ, "a byte too many lands in the canaries");

/* What is read is the last of the bus; canaries lie behind it. */
static struct {
    i2c_bus_t bus;
    uint8_t behind[16];
} memory;
static i2c_bus_t *const bus = &memory.bus;

static const struct {
    uint8_t tx_length, rx_length;
} transfers[] = { { 2, 0 }, { 1, 1 }, { 1, 2 }, { 1, 6 }, { 1, 8 }, { 1, LONGEST_READ } };
enum { TRANSFERS = sizeof transfers / sizeof transfers[0] };

typedef struct {
    uint8_t right;   /* the status that says that it went well (data sheet tables 26-3, 26-4) */
    uint8_t refused; /* the one that says that the device did not answer; 0: none */
    i2c_bus_state_t refused_as;
    command_t then; /* what follows the right one */
    uint8_t then_sent;
} step_t;

static step_t steps[STEPS_MAX];
static unsigned step_count;

static void add(uint8_t right, uint8_t refused, i2c_bus_state_t refused_as, command_t then, uint8_t then_sent)
{
    steps[step_count++] = (step_t){ right, refused, refused_as, then, then_sent };
}

/* The steps of a transfer as the bus's specification has them (UM10204 3.1.10). */
static void write_down(unsigned tx_length, unsigned rx_length)
{
    step_count = 0;
    add(0x08, 0, I2C_BUS_ERROR, SEND, ADDRESS);
    add(0x18, 0x20, I2C_BUS_NACK_ADDRESS, SEND, 0xA0);
    for (unsigned i = 0; i < tx_length; i++) {
        bool last = i + 1 == tx_length;
        add(0x28, 0x30, I2C_BUS_NACK_DATA, !last ? SEND : rx_length != 0 ? START : STOP, (uint8_t)(0xA1 + i));
    }
    if (rx_length == 0) {
        return;
    }
    add(0x10, 0, I2C_BUS_ERROR, SEND, ADDRESS | 1);
    add(0x40, 0x48, I2C_BUS_NACK_ADDRESS, rx_length > 1 ? RECEIVE_ACK : RECEIVE_NACK, 0);
    for (unsigned i = 1; i < rx_length; i++) {
        add(0x50, 0, I2C_BUS_ERROR, i + 1 < rx_length ? RECEIVE_ACK : RECEIVE_NACK, 0);
    }
    add(0x58, 0, I2C_BUS_ERROR, STOP, 0);
}

static void begin(unsigned transfer)
{
    memset(&memory, CANARY, sizeof memory);
    bus->state = I2C_BUS_IDLE;
    bus->address = ADDRESS;
    bus->tx_length = transfers[transfer].tx_length;
    bus->rx_length = transfers[transfer].rx_length;
    bus->tx[0] = 0xA0;
    bus->tx[1] = 0xA1;
    next_byte = FIRST_READ;
    i2c_bus_begin(bus);
    TEST_ASSERT_EQUAL(START, command);
    write_down(bus->tx_length, bus->rx_length);
}

static void event(uint8_t new_status)
{
    commands = 0;
    bus_status = new_status;
    i2c_bus_step(bus);
    TEST_ASSERT_EQUAL_UINT(1, commands); /* never none: the bus would stand still; never two */
}

static void go_well(unsigned from, unsigned end)
{
    for (unsigned i = from; i < end; i++) {
        event(steps[i].right);
        TEST_ASSERT_EQUAL(steps[i].then, command);
        if (command == SEND) {
            TEST_ASSERT_EQUAL_HEX8(steps[i].then_sent, sent);
        }
        TEST_ASSERT_EQUAL(i + 1 == step_count ? I2C_BUS_OK : I2C_BUS_BUSY, bus->state);
    }
}

/* The first `count` bytes came in, in order; nothing else was touched. */
static void assert_received(unsigned count)
{
    TEST_ASSERT_EQUAL_HEX8(0xA0, bus->tx[0]);
    TEST_ASSERT_EQUAL_HEX8(0xA1, bus->tx[1]);
    for (unsigned i = 0; i < LONGEST_READ; i++) {
        TEST_ASSERT_EQUAL_HEX8(i < count ? FIRST_READ + i : CANARY, bus->rx[i]);
    }
    for (unsigned i = 0; i < sizeof memory.behind; i++) {
        TEST_ASSERT_EQUAL_HEX8(CANARY, memory.behind[i]);
    }
}

static unsigned data_events_before(unsigned at)
{
    unsigned count = 0;
    for (unsigned i = 0; i < at; i++) {
        count += steps[i].right == 0x50 || steps[i].right == 0x58;
    }
    return count;
}

static bool data_asked_before(unsigned at)
{
    return at > 0 && (steps[at - 1].then == RECEIVE_ACK || steps[at - 1].then == RECEIVE_NACK);
}

TEST(test_transfers_do_their_steps)
{
    for (unsigned t = 0; t < TRANSFERS; t++) {
        begin(t);
        go_well(0, step_count);
        assert_received(transfers[t].rx_length);
        TEST_ASSERT_EQUAL_UINT(transfers[t].rx_length, i2c_bus_asked(bus));
    }
}

/* A first byte without I2C_BUS_MORE is followed by one, which is refused, however many were asked for. */
TEST(test_a_read_that_needs_no_more_ends_with_its_second_byte)
{
    for (unsigned first = 0; first <= 0xFF; first++) {
        for (unsigned t = 1; t < TRANSFERS; t++) {
            begin(t);
            unsigned reads = transfers[t].rx_length;
            unsigned expected = (first & 0x80u) != 0 || reads < 2 ? reads : 2;
            next_byte = (uint8_t)first;
            write_down(bus->tx_length, expected);
            go_well(0, step_count);
            for (unsigned i = 0; i < LONGEST_READ; i++) {
                TEST_ASSERT_EQUAL_HEX8(i < expected ? (uint8_t)(first + i) : CANARY, bus->rx[i]);
            }
            TEST_ASSERT_EQUAL_UINT(expected, i2c_bus_asked(bus));
        }
    }
}

static i2c_bus_state_t outcome(const step_t *step, unsigned s)
{
    if (s == 0x38) {
        return I2C_BUS_LOST;
    }
    return step->refused != 0 && s == step->refused ? step->refused_as : I2C_BUS_ERROR;
}

/*
 * A status that is right at another step (a repeated START in a write, a second START, a byte received while sending,
 * one byte more than asked for) is as wrong as any: the transfer ends, by its right name, with a STOP or a release, and
 * what is read stays within its bytes.
 */
TEST(test_every_wrong_status_at_every_step_ends_the_transfer)
{
    unsigned cases = 0;
    for (unsigned t = 0; t < TRANSFERS; t++) {
        begin(t);
        for (unsigned at = 0; at < step_count; at++) {
            for (unsigned s = 0; s <= 0xFF; s++) {
                if (s == steps[at].right) {
                    continue;
                }
                begin(t);
                go_well(0, at);
                event((uint8_t)s);
                TEST_ASSERT_EQUAL(outcome(&steps[at], s), bus->state);
                TEST_ASSERT_EQUAL(s == 0x38 ? RELEASE : STOP, command);
                assert_received(data_events_before(at));
                TEST_ASSERT_EQUAL_UINT(data_asked_before(at) ? data_events_before(at) + 1 : 0, i2c_bus_asked(bus));
                cases++;
            }
        }
    }
    /* START, address, register; then a byte, or START, address and the bytes; 255 wrong statuses each */
    TEST_ASSERT_EQUAL_UINT(255 * (4 + 6 + 7 + 11 + 13 + 15), cases);
}

/* After its end a transfer takes no more events, whatever they are. */
TEST(test_events_after_the_end_are_stale)
{
    for (unsigned s = 0; s <= 0xFF; s++) {
        begin(3);
        go_well(0, step_count);
        event((uint8_t)s);
        TEST_ASSERT_EQUAL(DISABLE, command);
        TEST_ASSERT_EQUAL(I2C_BUS_OK, bus->state);
        assert_received(6);
    }
}
