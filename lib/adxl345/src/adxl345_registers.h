/* ADXL345 registers, bits and reset values as in the data sheet, Rev. E, p. 23-27. */
#ifndef ADXL345_REGISTERS_H
#define ADXL345_REGISTERS_H

#define ADXL345_ADDRESS_LOW 0x53u  /* ALT ADDRESS to ground (p. 18) */
#define ADXL345_ADDRESS_HIGH 0x1Du /* ALT ADDRESS to VDD I/O */

enum adxl345_register {
    ADXL345_DEVID = 0x00,
    ADXL345_THRESH_TAP = 0x1D,
    ADXL345_OFSX = 0x1E,
    ADXL345_OFSY = 0x1F,
    ADXL345_OFSZ = 0x20,
    ADXL345_BW_RATE = 0x2C,
    ADXL345_POWER_CTL = 0x2D,
    ADXL345_INT_ENABLE = 0x2E,
    ADXL345_INT_MAP = 0x2F,
    ADXL345_INT_SOURCE = 0x30,
    ADXL345_DATA_FORMAT = 0x31,
    ADXL345_DATAX0 = 0x32,
    ADXL345_FIFO_CTL = 0x38,
    ADXL345_FIFO_STATUS = 0x39
};

enum adxl345_bits {
    ADXL345_DEVID_VALUE = 0xE5,
    ADXL345_BW_RATE_RESET = 0x0A,
    ADXL345_BW_RATE_MASK = 0x0F, /* 100 Hz is 0x0A, each step doubles */
    ADXL345_POWER_MEASURE = 0x08,
    ADXL345_INT_DATA_READY = 0x80,
    ADXL345_INT_EVENTS = 0x7C, /* taps, activity, inactivity, free fall: never without their function (p. 26) */
    ADXL345_INT_WATERMARK = 0x02,
    ADXL345_INT_OVERRUN = 0x01,
    ADXL345_FORMAT_SELF_TEST = 0x80,
    ADXL345_FORMAT_FULL_RES = 0x08,
    ADXL345_FORMAT_RANGE_MASK = 0x03, /* 2, 4, 8, 16 g */
    ADXL345_FIFO_BYPASS = 0x00,
    ADXL345_FIFO_STREAM = 0x80,
    ADXL345_FIFO_ENTRIES_MASK = 0x3F
};

#endif
