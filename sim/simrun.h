/*
 * simrun: the unmodified UNO firmware in libsimavr, with the virtual ADXL345 on its bus and a recorded stream in the
 * sensor. Each part below is one simrun_<part>.c with its own state; simrun_main.c ties them together. Time is
 * avr->cycle, CYCLES_PER_US per microsecond, from the start of the MCU.
 */
#ifndef SIMRUN_H
#define SIMRUN_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include "adxl345_model.h"
#include "avr_uart.h"
#include "feed.h"
#include "sim_avr.h"
#include "simrun_judge.h"
#include "twi_peripheral.h"

#define CYCLES_PER_US machine_size.cycles_per_us
#define CYCLES_PER_MS (machine_size.cycles_per_us * 1000u)
#define NEVER UINT64_MAX

/* samples that the judge can look back at: older ones decide nothing, and a day has 8.6 million at 100 Hz */
enum { SERVED_KEPT = 8192 };

enum { PIN_STRAP = 4 }; /* of port D */

/* --- exit statuses (docs: simrun --help) --- */
typedef enum {
    EXIT_OK = 0,
    EXIT_INTERNAL = 1, /* simrun itself failed: memory, writing a file; or a signal ended it */
    EXIT_INPUT = 2,    /* usage, or a file that cannot be read or is wrong */
    EXIT_CRASH = 3,    /* jump out of the program, access beyond RAM */
    EXIT_OPCODE = 4,   /* illegal opcode */
    EXIT_STACK = 5,    /* stack pointer at or below _end */
    EXIT_UART = 6,     /* a byte written to a UART that was not ready: lost on hardware */
    EXIT_RESETS = 7,   /* number of resets is not --expect-resets */
    EXIT_STOPPED = 8,  /* the firmware slept with interrupts off */
    EXIT_STALLED = 9,  /* no --max-ms, and the sensor was not used for 20 s: the stream would never end */
    EXIT_WRONG = 10,   /* --judge, and a row is wrong, stale or stamped before its predecessor */
    EXIT_RULE = 11,    /* a rule of the data sheet is broken that simavr does not check */
    EXIT_READER = 12   /* --pty, and the program at the other end does not read */
} exit_status_t;

/* --- options --- */
enum { TYPED_MAX = 64, FAULTS_MAX = 64 };

typedef struct {
    double at_ms;     /* not before this simulated time */
    const char *text; /* without the line end */
    bool setting;     /* from --rate and the like: it must not be refused */
} typed_line_t;

typedef struct {
    const char *fw, *in, *frames, *out, *served, *altered, *eeprom, *stats, *profile, *calls, *race, *vcd, *bootloader,
        *filter, *span;
    bool loop, pty, blank, judge, strap, alt_address;
    double ppm, max_ms, patience_s; /* max_ms 0: none */
    const adxl345_variant_t *variant;
    adxl345_part_t part;
    unsigned expect_resets, gdb_port;
    uint32_t seed, clock_start_us;
    typed_line_t typed[TYPED_MAX];
    size_t typed_count;
    const char *faults[FAULTS_MAX];
    size_t fault_count;
} options_t;

extern options_t options;
extern const char options_help[];

/* Fills `options` from the command line; prints the reason and exits with EXIT_INPUT (or EXIT_OK after --help). */
void options_parse(int argc, char **argv);

/* Parses an argument of --part into *part; false if it is not legal. */
bool part_take(const char *argument, adxl345_part_t *part);
/* The self-test shift of this variant, unless a --part has named another. */
void part_complete(const adxl345_variant_t *variant, adxl345_part_t *part);

/* --- the machine --- */
typedef struct {
    uint32_t end_of_ram;    /* _end: first free RAM address */
    uint32_t code_bytes;    /* .text */
    uint32_t flash_bytes;   /* .text and .data */
    uint32_t cycles_per_us; /* the processor's clock in MHz: 16, or the value of the symbol cpu_hz */
} program_size_t;

extern avr_t *mcu;
extern adxl345_model_t sensor;
extern twi_peripheral_t twi;
extern program_size_t machine_size;
extern uint64_t machine_steps; /* checks of PC and stack: the cost of the simulation, independent of the PC */

/* Loads the firmware (and boot loader), builds the MCU and attaches everything. Exits with EXIT_INPUT on a bad file. */
void machine_start(void);
/* Runs until the end; the status and, if it is not EXIT_OK, a reason (static text). */
exit_status_t machine_run(const char **reason);
/* The next event of some part has changed: sets the wake-up to the earliest. */
void machine_reschedule(void);
/* Ends the run; the first cause is reported. `reason` must stay valid. */
void machine_fail(exit_status_t status, const char *reason);
double machine_ms(void);
enum { OPCODE_SLEEP = 0x9588 };
unsigned machine_opcode_at(uint32_t pc);  /* byte address */
uint32_t machine_random(void);            /* xorshift32 from --seed */
bool machine_in_boot_loader(uint32_t pc); /* byte address; false without --bootloader */

/* --- resets of the MCU --- */
typedef enum { RESET_EXTERNAL, RESET_POWER_ON, RESET_BROWN_OUT } reset_t;
/* Call once every other part has started: sets up what a reset leaves to simrun; from here on resets are detected. */
void resets_start(void);
/* Requested from anywhere, done between two instructions; the last request counts. */
void resets_want(reset_t kind);
bool resets_wanted(void); /* a reset follows this instruction */
/* The pseudo terminal was opened: with a boot loader an external reset, as DTR gives an UNO; not counted. */
void resets_port_opened(void);
/* Between two instructions: counts a reset that happened, does a requested one. last_pc: start of the last step. */
void resets_watch(uint32_t last_pc);
uint32_t resets_count(void);
uint32_t resets_boot_count(void); /* from the boot loader; not counted above */

/* --- signals --- */
void signals_start(void);
bool signals_asked_to_end(void); /* by SIGINT or SIGTERM */

/* --- stack --- */
void stack_paint(void);                /* before the start */
void stack_paint_is(void);             /* takes the present RAM content as the paint (junk after a power cycle) */
bool stack_watch(uint32_t end_of_ram); /* true: SP is suspiciously low, check again after each instruction */
uint16_t stack_high_water(void);       /* bytes used so far */

/* --- the wires of the bus (--wires, simrun_wires.c) --- */
bool wires_take(const char *argument); /* OHM,PF or OHM,PF,PF_OF_SDA; false: it is not legal */
void wires_start(void);                /* before the machine starts */

/* --- files written --- */
FILE *output_open(const char *path); /* exits with EXIT_INPUT and the reason */
/* Exits with EXIT_INTERNAL if anything written to it was lost; does nothing for NULL. */
void output_close(FILE *file, const char *path);

/* --- a starved main loop (simrun_starve.c) --- */
/* While on, no instruction is executed outside interrupt handlers and sections with interrupts off; a reset ends it. */
void starve(bool on);

/* --- ELF symbols --- */
void symbols_load(const char *path, program_size_t *size);
/* Byte address of a function, with or without the compiler's suffix (.lto_priv.0); false if there is none. */
bool symbols_find(const char *name, uint32_t *pc);
/* Address in data space of a variable of the firmware. */
bool symbols_find_variable(const char *name, uint32_t *address);
/* "name+0x12" of the function that contains pc; static text. */
const char *symbols_nearest(uint32_t pc);
const char *symbols_variable_at(uint32_t address); /* the same for the variable at an address in data space */

/* --- boot loader (--bootloader) --- */
/* Loads the image into the flash; returns its lowest address. Exits with EXIT_INPUT on a bad file. */
uint32_t bootloader_load(void);

/* --- sensor: clock of the virtual ADXL345 and the feed of rows --- */
void sensor_start(void);
void sensor_finish(void);
uint64_t sensor_next(void);
void sensor_step(void);
void sensor_check_rate(void);
void sensor_show_pin(void); /* drive D2 again (after a reset, or if the wire changed) */
void sensor_hold_int1(bool cut, bool high);
void sensor_disturb_int1(bool disturbed); /* the wire has the opposite of the sensor's level */
void sensor_set_clock_error(double ppm);
uint64_t sensor_last_tick(void);               /* cycle of the last output-data-rate tick, 0: none */
uint64_t sensor_over_at(void);                 /* cycle at which the stream ended, NEVER before that */
double sensor_period_us(void);                 /* of the last rate in force, without ppm; 0: none yet */
double sensor_true_period_us(void);            /* the same with the error of the sensor's clock */
size_t sensor_served_count(void);              /* of the whole run */
served_t *sensor_served_lately(size_t *count); /* the newest served, at least SERVED_KEPT if there were as many */
void sensor_print(FILE *json);                 /* its configuration at the end, and when it last measured */
void sensor_print_mode(FILE *to);              /* which feed mode was used */
const stream_t *sensor_stream(void);

/* --- UART --- */
void uart_start(void);
void uart_finish(void);
void uart_reset(void); /* after a reset of the MCU */
uint64_t uart_next(void);
void uart_step(void);
void uart_flood(bool on);        /* random bytes without a pause, instead of typed lines */
void uart_spoil(bool lost);      /* the next byte received has FE0, or DOR0 */
void uart_stall(uint64_t until); /* the transmitter holds each byte until this cycle; 0: no longer */
uint64_t uart_last_tx(void);     /* cycle of the last byte sent, 0: none */
uint64_t uart_bytes(void);
uint32_t uart_rx_overruns(void);
uint64_t uart_frame_cycles(void); /* duration of a byte that begins at this moment */

/* --- the transmitter of the UART --- */
void transmitter_start(avr_uart_t *of, void (*on_byte)(uint8_t byte)); /* on_byte: called as its start bit is sent */
void transmitter_reset(void);

/* --- a PC that sends frames (--frames, simrun_frames.c) --- */
/* Reads the file; exits with EXIT_INPUT and the location on a bad one. Does nothing without --frames. */
void frames_start(void);
bool frames_take(uint8_t byte); /* from the board; true: the end of a record, there may be something to send */
/* False: nothing to send; look again at this cycle, or after the next record if it is NEVER. */
bool frames_next_byte(uint8_t *byte, uint64_t *look_again);
uint64_t frames_over_at(void); /* cycle at which the last frame was answered, NEVER before that */
bool frames_silent(void);      /* the board has owed a reply for too long */
void frames_print(FILE *json);

/* --- pseudo terminal (--pty) --- */
void pty_open(void);
void pty_send(uint8_t byte);
bool pty_receive(uint8_t *byte);
void pty_pace(void); /* sleep until real time has caught up; if it is far ahead, do not try to catch up with it */

/* --- EEPROM (--eeprom) --- */
void eeprom_start(void);
void eeprom_finish(void);
void eeprom_reset(bool power_lost);
/* Content that a power cycle leaves in the cell being written: erased, the old or the new byte, or junk. */
typedef enum { EEPROM_LEFT_FF, EEPROM_LEFT_OLD, EEPROM_LEFT_NEW, EEPROM_LEFT_RANDOM } eeprom_left_t;
void eeprom_leave(eeprom_left_t what);
void eeprom_print(FILE *json);
uint64_t eeprom_next(void);
void eeprom_step(void);

/* --- faults --- */
/* Parses options.faults; exits with EXIT_INPUT and the reason. Needs the symbols. */
void faults_start(void);
uint64_t faults_next(void);
void faults_step(void);
void faults_on_sample(void);
void faults_on_byte(uint32_t transfer, uint32_t byte);
void faults_after_byte(void);
typedef enum { EEPROM_IN, EEPROM_BEFORE, EEPROM_AFTER } eeprom_moment_t;
void faults_on_eeprom_write(uint32_t count, eeprom_moment_t moment);
extern bool faults_watch_pc;
void faults_on_pc(uint32_t pc);
void faults_on_row(const row_t *row);
bool faults_over(void);     /* some faults have occurred, none is in progress, and each has had its good row */
void faults_on_reset(void); /* of the MCU: ends starvation */
void faults_print(FILE *json);
void faults_warn(void); /* stderr: faults that never occurred */

/* --- faults that alter values (simrun_alter.c) --- */
void alter_start(void);
void alter_finish(void);
uint32_t alter_count(void);                        /* samples that arrived different from what was sent */
const int16_t *alter_sample(const int16_t lsb[3]); /* what the sensor measures instead */
uint64_t alter_next(void);
void alter_step(void);

/* --- rows compared with what the sensor latched (simrun_judge.h) --- */
void verdict_start(void);
void verdict_on_row(const row_t *row);
void verdict_print(FILE *json);
void verdict_tell(void); /* stderr */
/* The first faulty row with --judge; NULL if there is none. */
const char *verdict_reason(void);

/* --- the rows, counted as they arrive (simrun_rows.c) --- */
void rows_take(const row_t *row);
size_t rows_count(void);
void rows_print(FILE *json);

/* --- gaps between good rows (simrun_flow.c) --- */
void flow_on_row(const row_t *row); /* call before the faults see the row */
void flow_print(FILE *json);

/* --- rules of the data sheet (simrun_rules.c) --- */
void rules_start(void); /* once every other part has its registers */
void rules_on_reset(void);
void rules_on_step(uint32_t from); /* a step that began there may have ended with SLEEP, or with interrupts enabled */
void rules_print(FILE *json);

/* --- statistics --- */
extern uint64_t stats_slept;       /* cycles asleep */
extern uint64_t stats_interrupted; /* cycles in interrupt handlers, entry and return included */
extern bool stats_profiling;       /* for --profile or --calls */
uint64_t stats_own_cycles(void);   /* awake, without the responses to interrupts */
bool stats_in_interrupt(void);
const char *stats_vector_name(unsigned vector); /* as in --stats; static text */
void stats_start(void);
void stats_reset(void);
void stats_profile(uint32_t pc, uint64_t cycles);
void stats_profile_write(void);
void stats_write(exit_status_t status);
void stats_summary(void);
/* Streaming, for the load: first row, end of the stream. */
void stats_streaming_begins(void);
void stats_streaming_ends(void);

/* --- cycles by call chain (--calls) --- */
void calls_on_step(uint32_t pc, uint64_t cycles, bool interrupt); /* interrupt: it is the instruction in a vector */
void calls_reset(void);
void calls_write(void);

/* --- memory accesses of an instruction (simrun_access.c) --- */
typedef struct {
    uint16_t address; /* in data space */
    bool reads, writes;
} access_t;
access_t access_at(uint32_t pc); /* neither reads nor writes: no access, or one to the stack */

/* --- interrupts at accesses that main shares with their handlers (--race) --- */
extern bool race_wanted;
void race_start(void);
/* Before each step; awake: it is an instruction. May let time pass and enter a handler; true: check everything. */
bool race_on_step(bool awake);
void race_finish(void); /* stderr, and the file */

/* --- passes of the main loop --- */
void pass_start(void);
void pass_reset(void);
void pass_ends(void); /* main sleeps, or the next pass begins */
void pass_print(FILE *json);

/* --- cycles from function to function (--span) --- */
extern bool span_wanted;
/* Needs the symbols; exits with EXIT_INPUT if a name is unknown. */
void span_start(void);
void span_on_pc(uint32_t pc);
void span_reset(void);
void span_finish(void);

/* --- VCD (--vcd) --- */
enum { VCD_INT1, VCD_SDA_LOW, VCD_SCL_LOW, VCD_TX, VCD_RX, VCD_ISR };
void vcd_start(void);
void vcd_change(unsigned signal, uint32_t value);
void vcd_finish(void);

#endif
