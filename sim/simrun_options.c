/* The command line. */
#include <getopt.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "simrun.h"

options_t options = { .seed = 1 };

#define PATIENCE_S 60.0

enum option_code {
    OPTION_FW = 256,
    OPTION_IN,
    OPTION_FRAMES,
    OPTION_OUT,
    OPTION_SERVED,
    OPTION_ALTERED,
    OPTION_EEPROM,
    OPTION_STATS,
    OPTION_PROFILE,
    OPTION_CALLS,
    OPTION_SPAN,
    OPTION_VCD,
    OPTION_BOOTLOADER,
    OPTION_BLANK,
    OPTION_STRAP,
    OPTION_ALT_ADDRESS,
    OPTION_LOOP,
    OPTION_PTY,
    OPTION_PPM,
    OPTION_MAX_MS,
    OPTION_EXPECT_RESETS,
    OPTION_GDB,
    OPTION_SEED,
    OPTION_JUDGE,
    OPTION_CLOCK_START,
    OPTION_CMD,
    OPTION_FAULT,
    OPTION_SETTING,
    OPTION_FILTER,
    OPTION_PART,
    OPTION_PATIENCE,
    OPTION_HELP
};

static const struct option known[] = { { "fw", required_argument, NULL, OPTION_FW },
                                       { "in", required_argument, NULL, OPTION_IN },
                                       { "frames", required_argument, NULL, OPTION_FRAMES },
                                       { "out", required_argument, NULL, OPTION_OUT },
                                       { "served", required_argument, NULL, OPTION_SERVED },
                                       { "altered", required_argument, NULL, OPTION_ALTERED },
                                       { "eeprom", required_argument, NULL, OPTION_EEPROM },
                                       { "stats", required_argument, NULL, OPTION_STATS },
                                       { "profile", required_argument, NULL, OPTION_PROFILE },
                                       { "calls", required_argument, NULL, OPTION_CALLS },
                                       { "span", required_argument, NULL, OPTION_SPAN },
                                       { "vcd", required_argument, NULL, OPTION_VCD },
                                       { "bootloader", required_argument, NULL, OPTION_BOOTLOADER },
                                       { "blank", no_argument, NULL, OPTION_BLANK },
                                       { "strap", no_argument, NULL, OPTION_STRAP },
                                       { "alt-address", no_argument, NULL, OPTION_ALT_ADDRESS },
                                       { "loop", no_argument, NULL, OPTION_LOOP },
                                       { "pty", no_argument, NULL, OPTION_PTY },
                                       { "ppm", required_argument, NULL, OPTION_PPM },
                                       { "max-ms", required_argument, NULL, OPTION_MAX_MS },
                                       { "patience", required_argument, NULL, OPTION_PATIENCE },
                                       { "expect-resets", required_argument, NULL, OPTION_EXPECT_RESETS },
                                       { "gdb", required_argument, NULL, OPTION_GDB },
                                       { "seed", required_argument, NULL, OPTION_SEED },
                                       { "judge", no_argument, NULL, OPTION_JUDGE },
                                       { "clock-start", required_argument, NULL, OPTION_CLOCK_START },
                                       { "cmd", required_argument, NULL, OPTION_CMD },
                                       { "fault", required_argument, NULL, OPTION_FAULT },
                                       { "rate", required_argument, NULL, OPTION_SETTING },
                                       { "baud", required_argument, NULL, OPTION_SETTING },
                                       { "every", required_argument, NULL, OPTION_SETTING },
                                       { "range", required_argument, NULL, OPTION_SETTING },
                                       { "filter", required_argument, NULL, OPTION_FILTER },
                                       { "part", required_argument, NULL, OPTION_PART },
                                       { "help", no_argument, NULL, OPTION_HELP },
                                       { NULL, 0, NULL, 0 } };

static const char help_text[] =
    "simrun --fw ELF --in CSV --out CSV [options]: runs the UNO's firmware on a recorded stream\n"
    "\n"
    "  --fw ELF           firmware for the ATmega328P; 16 MHz unless its symbol cpu_hz says less\n"
    "  --in CSV           stream: t_us,x,y,z or t_us,x_lsb,y_lsb,z_lsb (as it reads)\n"
    "  --frames FILE      instead of --in, for the navigation image: 'DUE_US HEX' a frame, sent when it is due and "
    "when "
    "the\n"
    "                     board has room for it (docs/protocol.md, Navigation image)\n"
    "  --out CSV          every byte the firmware's UART sends\n"
    "  --loop             begin the stream again at its end (needs --max-ms)\n"
    "  --max-ms N         end after N ms of simulated time\n"
    "  --filter NAME --rate HZ --range G --every N --baud N\n"
    "                     typed as commands, in this order of options, when the banner has appeared\n"
    "  --cmd MS:TEXT      types TEXT and a line end, not before MS\n"
    "  --ppm N            error of the sensor's clock\n"
    "  --part 'gain=X,Y,Z offset=X,Y,Z selftest=X,Y,Z'\n"
    "                     this ADXL345: gain (1,1,1) times the stream's LSB, then offset (0,0,0) and, while SELF_TEST "
    "is set,\n"
    "                     its shift (522,-522,698: typical at 3.3 V) in LSB; any of the three, also in several --part\n"
    "  --served CSV       every sample the sensor latched: served,t_us,row,line,x_lsb,y_lsb,z_lsb[,truth]\n"
    "  --altered CSV      every sample that a fault altered on its way to the MCU: altered,t_us,x_lsb,y_lsb,z_lsb as "
    "it "
    "arrived,\n"
    "                     x_sent_lsb,y_sent_lsb,z_sent_lsb as the sensor sent it\n"
    "  --stats JSON       statistics of the run\n"
    "  --judge            exit status 10 unless every row is right: its readings are what the sensor latched within "
    "two "
    "sample\n"
    "                     periods of its t_us and what no row has shown before, or a flag 1, 2, 16, 32 or 64 disowns\n"
    "                     them; and no t_us steps back. Counted without it too: rows_judged, rows_wrong, rows_stale,\n"
    "                     rows_twice, t_us_steps_back in --stats, and on stderr\n"
    "  --clock-start US   what the firmware's clock reads when Timer1 begins to count (0)\n"
    "  --strap            D4 is at ground: the firmware starts with default settings\n"
    "  --alt-address      ALT ADDRESS of the sensor is high: it answers at 0x1D, not at 0x53\n"
    "  --fault WHEN:KIND[:PARAM][:MS]\n"
    "    WHEN   12.3ms | xfer:N.K (byte K of I2C transfer N, the address is byte 1) | pc:SYMBOL[#N] (Nth time it is "
    "reached)\n"
    "           | eeprom:N[.before|.after] (in the Nth EEPROM write, or just before or after it)\n"
    "           | p:1e-3 (per sample, from --seed)\n"
    "    KIND   unplug[:MS] plug power[:MS]  sensor off the bus and supply, back, off and on\n"
    "           sda[:MS] scl[:MS]            line held low\n"
    "           hang[:CLOCKS]                slave holds SDA low for so many clocks (5), then goes on where it "
    "stopped\n"
    "           arb buserr nack nackdata     once: arbitration lost, bus error, address or data refused\n"
    "           devid[:VALUE][:MS]           DEVID reads VALUE (0)\n"
    "           noint[:MS]                   INT1 does not reach D2\n"
    "           inthigh[:MS]                 D2 is high whatever INT1 is\n"
    "           torn                         slave lets go of SDA for the rest of the read: ones\n"
    "           reset brownout               MCU: external reset; brown-out\n"
    "           mcupower[:LEFT]              power cycle with junk in the MCU's RAM; leaves of an EEPROM byte that is\n"
    "                                        being written: ff, old, new or random (random)\n"
    "           starve[:MS] overrun[:N]      main loop without time, interrupts go on: for MS; until the sensor's "
    "FIFO\n"
    "                                        has lost N samples (1). A reset of the MCU ends both\n"
    "           poke:SYMBOL=VALUE            a byte of the firmware's RAM\n"
    "           flip[:BITS]                  once: so many bits (1) of the next byte from the sensor arrive flipped *\n"
    "           noise[:SIGMA] double[:AXIS]  once: the next sample read has noise (20 LSB rms), or twice the value of "
    "z, "
    "x or y *\n"
    "           frozen[:MS]                  the sensor measures the same readings again and again\n"
    "           mixed                        once: the rest of the next sample read is of the one before *\n"
    "           clip[:AXIS][:MS]             the axis (z) is beyond the range\n"
    "           glitch storm[:HZ[:MS]]       pulse of up to 4 us on INT1 against its level, one or many (1000 Hz)\n"
    "           odr[:PPM[:MS]]               error of the sensor's clock (50000), instead of --ppm\n"
    "           rxflood[:MS] txstall[:MS]    random bytes to the UART without a pause; its transmitter stands still\n"
    "           rxspoil[:LOST]               once: the next byte typed has no stop bit (0), or comes after one that "
    "found "
    "no\n"
    "                                        room in the receiver (1)\n"
    "           * altered inside a well-formed transfer, behind the sensor: --served stays true, and no firmware can "
    "see "
    "every\n"
    "             one (fault_N_detectable is false in --stats)\n"
    "           with p: what the bus suffers once begins at a random byte of the next transfer, a state only when it "
    "is "
    "over\n"
    "           without MS a state lasts to the end (power: 5 ms)\n"
    "  --seed N           for p:, junk in RAM (1)\n"
    "  --expect-resets N  MCU resets that are right, injected ones included (0)\n"
    "  --bootloader HEX   load this image too and start in it by an external reset; resets out of it are not counted\n"
    "  --blank            with --bootloader: the flash holds nothing else; --fw names what will be written\n"
    "  --eeprom FILE      1024 bytes, read if there, written at the end\n"
    "  --profile FILE     CSV pc,count,cycles,symbol of every instruction executed\n"
    "  --calls FILE       CSV cell,frame,pc,count,cycles,symbol: the same by callers; a frame is the cell of its call\n"
    "  --span FROM:TO:CSV at_us,cycles,stack_bytes from the entry of function FROM to that of TO, without interrupts\n"
    "  --vcd FILE         D2, stuck lines, UART bytes and interrupt handlers, for GTKWave\n"
    "  --gdb PORT         wait for avr-gdb before the first instruction\n"
    "  --pty              connect the UART to a pseudo terminal, in real time; with --bootloader opening it resets the "
    "MCU,\n"
    "                     as DTR resets an UNO (not counted), and with --blank nothing runs until then\n"
    "                     and the boot loader waits for the first byte (5 s of real time at most)\n"
    "  --patience S       with --pty: a program that holds the terminal and reads nothing for so long ends the run "
    "(60)\n"
    "\n"
    "The run ends 20 ms after the stream, when the UART has been silent for 30 ms (2 s at most); with --pty or --gdb "
    "Ctrl-C\n"
    "ends it too.\n"
    "Exit status: 0 ran to the end; 1 simrun failed, or a signal ended it; 2 usage or input; 3 crash;\n"
    "4 illegal opcode; 5 stack overrun; 6 UART overrun; 7 unexpected number of resets;\n"
    "8 firmware slept with interrupts off;\n"
    "9 without --max-ms: the firmware did not use the sensor for 20 s; 10 --judge: a row is not right;\n"
    "11 a rule of the data sheet is broken that simavr does not hold (the words say which);\n"
    "12 with --pty: a program held the terminal and read nothing for the time of --patience.\n";

static void refuse(const char *format, ...) __attribute__((format(printf, 1, 2), noreturn));
static void refuse(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    fputs("simrun: ", stderr);
    vfprintf(stderr, format, arguments);
    fputs(" (simrun --help)\n", stderr);
    va_end(arguments);
    exit(EXIT_INPUT);
}

static double number(const char *name, const char *text, double low, double high)
{
    char *end;
    double value = strtod(text, &end);
    if (end == text || *end != '\0' || !(value >= low && value <= high)) {
        refuse("--%s wants a number from %g to %g, not '%s'", name, low, high, text);
    }
    return value;
}

static void add_typed(double at_ms, const char *text, bool setting)
{
    if (options.typed_count == TYPED_MAX) {
        refuse("more than %d commands", TYPED_MAX);
    }
    options.typed[options.typed_count++] = (typed_line_t){ at_ms, text, setting };
}

/* "--rate 400" is the command "rate 400". */
static void add_setting(const char *name, const char *value)
{
    size_t length = strlen(name) + strlen(value) + 2;
    char *line = malloc(length);
    if (line == NULL) {
        refuse("out of memory");
    }
    snprintf(line, length, "%s %s", name, value);
    add_typed(0.0, line, true);
}

static void add_command(const char *argument)
{
    char *end;
    double at_ms = strtod(argument, &end);
    if (end == argument || *end != ':' || !(at_ms >= 0.0)) {
        refuse("--cmd wants MS:TEXT, not '%s'", argument);
    }
    add_typed(at_ms, end + 1, false);
}

static void add_part(const char *argument)
{
    if (!part_take(argument, &options.part)) {
        refuse("--part wants gain=X,Y,Z (0.5 to 2), offset=X,Y,Z (-1000 to 1000) or selftest=X,Y,Z (-4096 to 4095), "
               "whole LSB, not '%s'",
               argument);
    }
}

static void add_fault(const char *argument)
{
    if (options.fault_count == FAULTS_MAX) {
        refuse("more than %d faults", FAULTS_MAX);
    }
    options.faults[options.fault_count++] = argument;
}

/* Options that only keep a name; false when it is none of them. */
static bool take_file(int code, const char *argument)
{
    static const struct {
        int code;
        const char **target;
    } files[] = {
        { OPTION_FW, &options.fw },           { OPTION_IN, &options.in },
        { OPTION_OUT, &options.out },         { OPTION_SERVED, &options.served },
        { OPTION_EEPROM, &options.eeprom },   { OPTION_STATS, &options.stats },
        { OPTION_VCD, &options.vcd },         { OPTION_PROFILE, &options.profile },
        { OPTION_SPAN, &options.span },       { OPTION_BOOTLOADER, &options.bootloader },
        { OPTION_ALTERED, &options.altered }, { OPTION_FRAMES, &options.frames },
        { OPTION_CALLS, &options.calls },
    };
    for (size_t i = 0; i < sizeof files / sizeof files[0]; i++) {
        if (files[i].code == code) {
            *files[i].target = argument;
            return true;
        }
    }
    return false;
}

static bool take_number(int code, const char *name, const char *argument)
{
    switch (code) {
    case OPTION_PPM:
        options.ppm = number(name, argument, -200000.0, 200000.0);
        return true;
    case OPTION_MAX_MS:
        options.max_ms = number(name, argument, 0.001, 1e9);
        return true;
    case OPTION_PATIENCE:
        options.patience_s = number(name, argument, 0.01, 1e6);
        return true;
    case OPTION_EXPECT_RESETS:
        options.expect_resets = (unsigned)number(name, argument, 0.0, 1e6);
        return true;
    case OPTION_GDB:
        options.gdb_port = (unsigned)number(name, argument, 1.0, 65535.0);
        return true;
    case OPTION_SEED:
        options.seed = (uint32_t)number(name, argument, 1.0, 4294967295.0);
        return true;
    case OPTION_CLOCK_START:
        options.clock_start_us = (uint32_t)number(name, argument, 0.0, 4294967295.0);
        return true;
    default:
        return false;
    }
}

static void take(int code, const char *name, const char *argument)
{
    switch (code) {
    case OPTION_LOOP:
        options.loop = true;
        break;
    case OPTION_PTY:
        options.pty = true;
        break;
    case OPTION_BLANK:
        options.blank = true;
        break;
    case OPTION_STRAP:
        options.strap = true;
        break;
    case OPTION_ALT_ADDRESS:
        options.alt_address = true;
        break;
    case OPTION_JUDGE:
        options.judge = true;
        break;
    case OPTION_CMD:
        add_command(argument);
        break;
    case OPTION_FAULT:
        add_fault(argument);
        break;
    case OPTION_PART:
        add_part(argument);
        break;
    case OPTION_FILTER:
        options.filter = argument;
        add_setting(name, argument);
        break;
    case OPTION_SETTING:
        add_setting(name, argument);
        break;
    case OPTION_HELP:
        fputs(help_text, stdout);
        exit(EXIT_OK);
    default:
        if (!take_file(code, argument) && !take_number(code, name, argument)) {
            exit(EXIT_INPUT); /* getopt has said why */
        }
        break;
    }
}

/* One of the two ways in which something comes to the firmware, and where what it says goes. */
static void check_files(void)
{
    if (options.fw == NULL || options.out == NULL || (options.in == NULL && options.frames == NULL)) {
        refuse("--fw, --in (or --frames) and --out are needed");
    }
    if (options.frames != NULL && (options.in != NULL || options.pty)) {
        refuse("--frames goes with neither --in nor --pty");
    }
}

/* What is wrong only in combination. */
static void check_together(void)
{
    check_files();
    if (options.blank && options.bootloader == NULL) {
        refuse("--blank leaves nothing to run: give --bootloader");
    }
    if (options.patience_s > 0.0 && !options.pty) {
        refuse("--patience is for a terminal: give --pty");
    }
    if (options.loop && options.max_ms <= 0.0 && options.gdb_port == 0 && !options.pty) {
        refuse("--loop never ends: give --max-ms");
    }
}

void options_parse(int argc, char **argv)
{
    int index = 0;
    int code;
    options.part = adxl345_part_typical;
    while ((code = getopt_long(argc, argv, "", known, &index)) != -1) {
        take(code, known[index].name, optarg);
    }
    if (optind < argc) {
        refuse("'%s' is no option", argv[optind]);
    }
    check_together();
    options.patience_s = options.patience_s > 0.0 ? options.patience_s : PATIENCE_S;
}
