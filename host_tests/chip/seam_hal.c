/* The I2C handler through the HAL's verbs; seam_direct.c is the same with the registers written out. */
#include "hal_i2c.h"
#include "seam_bus.h"

#define STATUS() hal_i2c_status()
#define START() hal_i2c_start()
#define SEND(byte) hal_i2c_send(byte)
#define RECEIVE(ack) hal_i2c_receive(ack)
#define RECEIVED() hal_i2c_received()
#define STOP() hal_i2c_stop()

HAL_I2C_ISR()
{
#include "seam_body.h"
}
