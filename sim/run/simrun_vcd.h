/* Waveforms for GTKWave (--vcd). */
#ifndef SIMRUN_VCD_H
#define SIMRUN_VCD_H

#include <stdint.h>

enum { VCD_INT1, VCD_SDA_LOW, VCD_SCL_LOW, VCD_TX, VCD_RX, VCD_ISR };
void vcd_start(const char *path); /* NULL: none */
void vcd_change(unsigned signal, uint32_t value);
void vcd_finish(void);

#endif
