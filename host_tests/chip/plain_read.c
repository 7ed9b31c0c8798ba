/*
 * A driver that believes what it reads: takes the place of adxl345_integrity.c's verdict in an image that shows what
 * that verdict costs (system test supervision).
 */
#include "adxl345_integrity.h"

reading_t plain_judge(const uint8_t reading[READING_BYTES], int16_t lsb[3], const int16_t last_lsb[3]);

reading_t plain_judge(const uint8_t reading[READING_BYTES], int16_t lsb[3], const int16_t last_lsb[3])
{
    (void)last_lsb;
    const uint8_t *raw = &reading[READING_DATA];
    for (uint8_t axis = 3; axis != 0; axis--) {
        uint8_t low = *raw++;
        uint8_t high = *raw++;
        *lsb++ = (int16_t)(uint16_t)(low | (uint16_t)((uint16_t)high << 8));
    }
    return READING_GOOD;
}
