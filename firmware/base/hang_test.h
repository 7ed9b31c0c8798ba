/*
 * Test images only (HANG_TEST=1): the bits of a byte, set by the test, stop single stages of the main loop, to show
 * that the watchdog notices each of them alone. In the shipped image the tests below are constant and are optimised
 * out.
 */
#ifndef HANG_TEST_H
#define HANG_TEST_H

#ifndef HANG_TEST
#define HANG_TEST 0
#endif

#if HANG_TEST
#include <stdint.h>
volatile uint8_t *hang_stages_here(void); /* bits of health_stage; 0x80: the whole loop */
#define HANGS(stage) ((*hang_stages_here() & (stage)) != 0)
#else
#define HANGS(stage) 0
#endif

#endif
