#include "support/path.h"

#include "base/counters.h"
#include "path/coast.h"
#include "path/pipeline.h"
#include "settings/settings.h"

void path_start(uint8_t kind, uint16_t rate_dhz, uint8_t range_g, uint32_t t_us)
{
    counters_start();
    coast_wait(t_us);
    pipeline_reset();
    settings_defaults();
    pipeline_calibrate(&settings()->calibration);
    settings_take_filter(kind);
    pipeline_forget();
    pipeline_change(&settings()->choice, rate_dhz, range_g);
    pipeline_finish();
}
