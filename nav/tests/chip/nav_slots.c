/*
 * nav/lib alone on the chip, for nav/tests/nav_chip.c: it puts records into `box` when GPIOR2 asks, GPIOR0 tells when
 * a call begins and ends.
 */
#include "nav_box.h"

#include <avr/io.h>

nav_t nav __attribute__((used));
nav_config_t config __attribute__((used));
nav_box_t box __attribute__((used));

static void call(uint8_t which)
{
    GPIOR0 = which;
    if (which == NAV_CALL_IMU) {
        nav_imu(&nav, box.t_us, box.rate, box.force);
    } else if (which == NAV_CALL_GPS) {
        nav_gps(&nav, box.t_us, box.velocity, box.position);
    } else if (which == NAV_CALL_DOWN) {
        nav_down(&nav, box.t_us, box.down);
    } else {
        nav_field(&nav, box.t_us, box.field);
    }
    GPIOR0 = 0;
}

int main(void)
{
    GPIOR2 = NAV_ASKS_CONFIG;
    GPIOR0 = NAV_CALL_INIT;
    bool good = nav_init(&nav, &config);
    GPIOR0 = 0;
    while (good) {
        GPIOR2 = NAV_ASKS_RECORD;
        for (uint8_t which = NAV_CALL_IMU; which <= NAV_CALL_FIELD; which++) {
            if ((box.calls & (uint8_t)(1U << which)) != 0U) {
                call(which);
            }
        }
        GPIOR2 = NAV_TELLS_STATE;
    }
    GPIOR2 = NAV_REFUSES;
    for (;;) {
    }
}
