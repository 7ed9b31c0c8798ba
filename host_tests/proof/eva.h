/* Any value of an interval, for the drivers of make proof. */
#ifndef EVA_H
#define EVA_H

#include <__fc_builtin.h>
#include <stdbool.h>
#include <stdint.h>

#define ANY_U8(low, high) ((uint8_t)Frama_C_unsigned_char_interval(low, high))
#define ANY_U16(low, high) ((uint16_t)Frama_C_unsigned_int_interval(low, high))
#define ANY_S16(low, high) ((int16_t)Frama_C_int_interval(low, high))
#define ANY_U32(low, high) ((uint32_t)Frama_C_unsigned_long_interval(low, high))
#define ANY_S32(low, high) ((int32_t)Frama_C_long_interval(low, high))
#define ANY_BOOL() ((bool)Frama_C_unsigned_char_interval(0, 1))
#define ANY_S8(low, high) ((int8_t)Frama_C_int_interval(low, high))

#define S16_MIN (-32767 - 1)
#define S32_MIN (-2147483647L - 1)
#define ANY_Z() ANY_S16(S16_MIN, 32767)

#endif
