/* The image is the first part of the settings as they are in RAM; see settings_kept.h. */
#include "settings/settings_kept.h"

#include <stddef.h>

#include "filter_list.h"
#include "settings/settings.h"
#include "settings/store.h"

_Static_assert(STORE_IMAGE_SIZE == offsetof(settings_t, store_tail), "what is kept of the settings");
_Static_assert(offsetof(settings_t, version) == 0 && offsetof(settings_t, length) == 1 &&
                   offsetof(settings_t, calibration) == 2 && offsetof(calibration_t, scale_lsb_per_g_uq6) == 6 &&
                   offsetof(calibration_t, level_q14) == 12 && offsetof(calibration_t, axes) == 18 &&
                   sizeof(calibration_t) == 22,
               "where every version finds them");
_Static_assert((int)KEPT_OLDER == (int)STORE_OTHER_COPY, "the store's answers, in its order");

static uint8_t kept; /* kept_t */

uint8_t settings_kept(void)
{
    return kept;
}

void settings_unread(void)
{
    settings_defaults();
    kept = KEPT_UNREAD;
}

/* The kind of the filter with this mark; FILTER_KIND_COUNT if the image has none. */
static uint8_t kind_marked(uint8_t mark)
{
    uint8_t kind = 0;
    while (kind != FILTER_KIND_COUNT && settings_filter_mark(kind) != mark) {
        kind++;
    }
    return kind;
}

/* Finds the filter by its mark; false: this image has none, its first one is taken with shipped parameters. */
static bool find_filter(void)
{
    uint8_t kind = kind_marked(settings()->choice.mark);
    settings()->choice.filter = kind;
    if (kind == FILTER_KIND_COUNT) {
        settings_take_filter(0);
    }
    return kind != FILTER_KIND_COUNT;
}

void settings_load(void)
{
    uint8_t found = (uint8_t)store_load((uint8_t *)settings());
    if (found >= KEPT_GOOD && calibration_check(&settings()->calibration).why != CALIBRATION_GOOD) {
        found = KEPT_DAMAGED;
    }
    if (found < KEPT_GOOD) {
        settings_defaults();
    } else if (settings()->version != SETTINGS_VERSION) {
        settings_defaults_beside_calibration();
        found = KEPT_CALIBRATION;
    } else if (!find_filter()) {
        found = KEPT_NO_FILTER;
    }
    kept = found;
}
