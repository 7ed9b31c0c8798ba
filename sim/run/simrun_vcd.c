/*
 * Written here and not by simavr, whose writer loses its timer at every reset of the MCU. A
 * cycle at 16 MHz is 62.5 ns: 625 units of 100 ps.
 */
#include "simrun_vcd.h"

#include "simrun_mcu.h"
#include "simrun_output.h"

enum { SIGNAL_MAX = VCD_ISR + 26, UNITS_PER_US = 10000 };

static const struct {
    const char *name;
    unsigned width;
} wires[VCD_ISR] = {
    [VCD_INT1] = { "INT1_D2", 1 },    [VCD_SDA_LOW] = { "SDA_stuck_low", 1 }, [VCD_SCL_LOW] = { "SCL_stuck_low", 1 },
    [VCD_TX] = { "UART_TX_byte", 8 }, [VCD_RX] = { "UART_RX_byte", 8 },
};

static const char *const vectors[26] = { "RESET",        "INT0",         "INT1",         "PCINT0",       "PCINT1",
                                         "PCINT2",       "WDT",          "TIMER2_COMPA", "TIMER2_COMPB", "TIMER2_OVF",
                                         "TIMER1_CAPT",  "TIMER1_COMPA", "TIMER1_COMPB", "TIMER1_OVF",   "TIMER0_COMPA",
                                         "TIMER0_COMPB", "TIMER0_OVF",   "SPI",          "USART_RX",     "USART_UDRE",
                                         "USART_TX",     "ADC",          "EE_READY",     "ANALOG_COMP",  "TWI",
                                         "SPM_READY" };

static FILE *file;
static const char *file_path;
static uint64_t last_time = NEVER;

static void write_value(unsigned signal, uint32_t value)
{
    unsigned width = signal < VCD_ISR ? wires[signal].width : 1;
    char code = (char)('!' + (int)signal);
    if (width == 1) {
        fprintf(file, "%u%c\n", value != 0, code);
        return;
    }
    fputc('b', file);
    for (unsigned bit = width; bit-- > 0;) {
        fputc((value >> bit & 1u) ? '1' : '0', file);
    }
    fprintf(file, " %c\n", code);
}

void vcd_change(unsigned signal, uint32_t value)
{
    if (file == NULL) {
        return;
    }
    if (mcu->cycle != last_time) {
        last_time = mcu->cycle;
        fprintf(file, "#%llu\n", (unsigned long long)last_time * UNITS_PER_US / CYCLES_PER_US);
    }
    write_value(signal, value);
}

void vcd_start(const char *path)
{
    if (path == NULL) {
        return;
    }
    file_path = path;
    file = output_open(path);
    fputs("$timescale 100ps $end\n$scope module uno $end\n", file);
    for (unsigned i = 0; i < SIGNAL_MAX; i++) {
        if (i < VCD_ISR) {
            fprintf(file, "$var wire %u %c %s $end\n", wires[i].width, (char)('!' + (int)i), wires[i].name);
        } else {
            fprintf(file, "$var wire 1 %c ISR_%s $end\n", (char)('!' + (int)i), vectors[i - VCD_ISR]);
        }
    }
    fputs("$upscope $end\n$enddefinitions $end\n#0\n$dumpvars\n", file);
    for (unsigned i = 0; i < SIGNAL_MAX; i++) {
        write_value(i, 0);
    }
    fputs("$end\n", file);
    last_time = 0;
}

void vcd_finish(void)
{
    output_close(file, file_path);
}
