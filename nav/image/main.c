/* The navigation image: records from the PC through the filter, at the speed of the serial line. */
#include "hal_irq.h"
#include "hal_sleep.h"
#include "hal_time.h"
#include "hal_watchdog.h"
#include "nav_link.h"

int main(void)
{
    hal_time_init();
    hal_watchdog_start();
    hal_irq_enable();
    link_start();
    for (;;) {
        hal_watchdog_feed();
        if (!link_pass()) {
            hal_sleep_until_wake();
        }
    }
}
