/*
 * Rules of the ATmega328P's data sheet, and their consequences, that a program may break for years before it shows:
 * simavr behaves as if each were kept. The first one broken ends the run with status 11 and its text. Boot loaders are
 * not checked.
 */
#include "simrun_rules.h"

#include "sim_io.h"
#include "simrun_failure.h"
#include "simrun_mcu.h"

enum {
    REG_DDRB = 0x24,
    REG_PORTB = 0x25,
    REG_EECR = 0x3F,
    BIT_EEPE = 0x02,
    BIT_EEMPE = 0x04,
    EEMPE_CYCLES = 4,
    REG_SMCR = 0x53,
    BIT_SE = 0x01,
    REG_MCUSR = 0x54,
    BIT_PORF = 0x01,
    BIT_WDRF = 0x08,
    REG_WDTCSR = 0x60,
    BIT_WDE = 0x08,
    BIT_WDCE = 0x10,
    BITS_WDP = 0x27,
    WDCE_CYCLES = 4,
    REG_TIMSK1 = 0x6F,
    REG_TCNT1L = 0x84,
    REG_OCR1BH = 0x8B,
    REG_TWCR = 0xBC,
    REG_UCSR0C = 0xC2,
    FRAME_8N1 = 0x06,
    BIT_TWIE = 0x01,
    BIT_TWEN = 0x04,
    BIT_TWSTO = 0x10,
    BIT_TWSTA = 0x20,
    BIT_TWINT = 0x80,
    TWI_VECTOR = 24,
    LED = 1 << 5,
    JUST_OPENED = -2, /* simavr's interrupt_state */
    WATCHED_MAX = 16
};

/* Shortest watchdog period, 2048 cycles of 128 kHz less a tenth. */
#define WATCHDOG_SHORTEST (14ull * CYCLES_PER_MS)

typedef struct {
    void (*check)(uint8_t value);
    avr_io_write_t write;
    avr_io_read_t read;
    void *param;
} watched_t;

static watched_t watched[WATCHED_MAX];
static size_t watched_count;
static uint64_t eempe_at;
static uint64_t watchdog_bites = NEVER;
static uint64_t wdce_until;    /* writes to WDE and the period in WDTCSR take effect up to this cycle */
static uint32_t opened_at;     /* the instruction after the one that enabled interrupts */
static bool two_wire_answered; /* by a write of one to TWINT in its handler */
static uint8_t causes_left;    /* flags of MCUSR that the program has not cleared */
static bool led_lit;
static uint32_t led_flashes;

static void broken(const char *words)
{
    if (!mcu_in_boot_loader(mcu->pc)) {
        failure_set(EXIT_RULE, words);
    }
}

static bool interrupts_on(void)
{
    return mcu->sreg[S_I] != 0;
}

/* 16.3: the high bytes of Timer1's registers go through one byte shared by all accesses, those of handlers included. */
static void check_timer(uint8_t value)
{
    (void)value;
    if (interrupts_on() && mcu->data[REG_TIMSK1] != 0) {
        broken("a 16-bit register of Timer1 is used with interrupts on: a handler's use of another spoils it");
    }
}

/* 8.6.3: EEPE takes effect within four cycles of EEMPE, which an interrupt between them would exceed. */
static void check_eeprom(uint8_t value)
{
    if ((value & BIT_EEPE) != 0 && (mcu->data[REG_EECR] & BIT_EEPE) == 0) {
        if (interrupts_on()) {
            broken("an EEPROM byte is written with interrupts on: one between EEMPE and EEPE loses the write");
        } else if (mcu->cycle > eempe_at + EEMPE_CYCLES) {
            broken("EEPE is set more than four cycles after EEMPE: the write is lost");
        }
    }
    if (value & BIT_EEMPE) {
        eempe_at = mcu->cycle;
    }
}

/*
 * 11.8: the watchdog is turned off, or its period changed, by a write within four cycles of the one that sets WDCE and
 * WDE; 11.9.2: while WDRF is set in MCUSR it stays on regardless.
 */
static void check_watchdog(uint8_t value)
{
    if ((value & BIT_WDCE) != 0) {
        wdce_until = (value & BIT_WDE) != 0 ? mcu->cycle + WDCE_CYCLES : 0;
        return;
    }
    bool off = (value & BIT_WDE) == 0 && (mcu->data[REG_MCUSR] & BIT_WDRF) == 0;
    if (mcu->cycle <= wdce_until && (off || (value & BITS_WDP) != 0)) {
        watchdog_bites = NEVER;
    }
}

/*
 * 22.9.2: TWSTO is cleared once the STOP is on the bus; TWIE asks for the interrupt while TWINT is set, whether the
 * interface is on or not.
 */
static void check_two_wire(uint8_t value)
{
    if ((value & (BIT_TWIE | BIT_TWEN)) == BIT_TWIE) {
        broken("the two-wire interrupt is enabled without the interface: what was left in TWINT runs its handler");
    }
    if ((mcu->data[REG_TWCR] & BIT_TWSTO) != 0 && (value & BIT_TWSTA) != 0) {
        broken("a START is asked for while a STOP is on its way");
    }
    two_wire_answered = two_wire_answered || (value & BIT_TWINT) != 0;
}

/* 22.5.5: TWINT asks for the interrupt until a one is written to it. After that it may be set again at once. */
static void on_two_wire(avr_irq_t *irq, uint32_t running, void *param)
{
    (void)irq;
    (void)param;
    uint8_t asks = BIT_TWINT | BIT_TWEN | BIT_TWIE;
    if (running == 0 && !two_wire_answered && (mcu->data[REG_TWCR] & asks) == asks) {
        broken("the two-wire handler ends without clearing TWINT: it runs again at once, and again");
    }
    two_wire_answered = false;
}

/* Tables 20-8 to 20-11: eight bits, no parity, one stop bit, which is what the other end reads. */
static void check_frame(uint8_t value)
{
    if (value != FRAME_8N1) {
        broken("the UART's frame is not 8N1");
    }
}

/* 11.9.1: a flag is cleared by writing zero to it; ones do not set it. */
static void check_causes(uint8_t value)
{
    causes_left &= value;
}

static void look_at_led(void)
{
    bool lit = (mcu->data[REG_DDRB] & mcu->data[REG_PORTB] & LED) != 0;
    led_flashes += lit && !led_lit ? 1u : 0u;
    led_lit = lit;
}

static void on_write(avr_t *avr, avr_io_addr_t address, uint8_t value, void *param)
{
    watched_t *of = param;
    if (of->check != NULL) {
        of->check(value);
    }
    if (of->write != NULL) {
        of->write(avr, address, value, of->param);
    } else {
        avr->data[address] = value;
    }
    if (of->check == NULL) {
        look_at_led();
    }
}

static uint8_t on_read(avr_t *avr, avr_io_addr_t address, void *param)
{
    watched_t *of = param;
    of->check(0);
    return of->read != NULL ? of->read(avr, address, of->param) : avr->data[address];
}

static void watch_writes(avr_io_addr_t address, void (*check)(uint8_t value))
{
    watched_t *of = &watched[watched_count++];
    avr_io_addr_t io = AVR_DATA_TO_IO(address);
    *of = (watched_t){ .check = check, .write = mcu->io[io].w.c, .param = mcu->io[io].w.param };
    mcu->io[io].w.c = on_write;
    mcu->io[io].w.param = of;
}

static void watch_reads(avr_io_addr_t address, void (*check)(uint8_t value))
{
    watched_t *of = &watched[watched_count++];
    avr_io_addr_t io = AVR_DATA_TO_IO(address);
    *of = (watched_t){ .check = check, .read = mcu->io[io].r.c, .param = mcu->io[io].r.param };
    mcu->io[io].r.c = on_read;
    mcu->io[io].r.param = of;
}

void rules_start(void)
{
    for (avr_io_addr_t address = REG_TCNT1L; address <= REG_OCR1BH; address++) {
        watch_writes(address, check_timer);
    }
    watch_reads(REG_TCNT1L, check_timer);
    watch_writes(REG_EECR, check_eeprom);
    watch_writes(REG_WDTCSR, check_watchdog);
    watch_writes(REG_TWCR, check_two_wire);
    watch_writes(REG_UCSR0C, check_frame);
    watch_writes(REG_MCUSR, check_causes);
    watch_writes(REG_DDRB, NULL);
    watch_writes(REG_PORTB, NULL);
    for (int i = 0; i < mcu->interrupts.vector_count; i++) {
        if (mcu->interrupts.vector[i]->vector == TWI_VECTOR) {
            avr_irq_register_notify(&mcu->interrupts.vector[i]->irq[AVR_INT_IRQ_RUNNING], on_two_wire, NULL);
        }
    }
}

/* 11.9.1: each cause adds its flag to those that are left; a power-on clears the others. */
void rules_on_reset(void)
{
    if ((mcu->data[REG_MCUSR] & BIT_PORF) == 0) {
        mcu->data[REG_MCUSR] |= causes_left;
    }
    causes_left = mcu->data[REG_MCUSR];
    bool by_watchdog = (mcu->data[REG_MCUSR] & BIT_WDRF) != 0;
    watchdog_bites = by_watchdog ? mcu->cycle + WATCHDOG_SHORTEST : NEVER;
    eempe_at = 0;
    wdce_until = 0;
    look_at_led();
}

/*
 * 10.11.1: SLEEP sleeps only with SE set. 7.7: after SEI one more instruction runs before an interrupt. With another
 * one between it and SLEEP, a wake-up can be lost.
 */
void rules_on_step(uint32_t from)
{
    if (mcu->state == cpu_Sleeping && interrupts_on()) {
        if ((mcu->data[REG_SMCR] & BIT_SE) == 0) {
            broken("SLEEP without SE in SMCR: it does nothing");
        }
        bool alone = mcu_opcode_at(from) == OPCODE_SLEEP && from == opened_at;
        if (!alone) {
            broken("SLEEP does not follow the SEI that lets interrupts in: a wake-up before it is lost");
        }
    }
    if (mcu->interrupt_state == JUST_OPENED) {
        opened_at = mcu->pc;
    }
    if (mcu->cycle >= watchdog_bites) {
        broken("the watchdog is on with its shortest period since it bit: it will bite again");
    }
}

void rules_print(FILE *json)
{
    fprintf(json, "  \"led_flashes\": %u,\n", (unsigned)led_flashes);
}
