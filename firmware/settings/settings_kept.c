/* The image is the head of the settings as they lie in RAM; see settings_kept.h. */
#include "settings/settings_kept.h"

#include <stddef.h>

#include "filter_list.h"
#include "settings/settings.h"
#include "settings/store.h"

_Static_assert(STORE_IMAGE_SIZE == offsetof(settings_t, store_tail), "what is kept of the settings");
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

/* The kind whose name has this mark; FILTER_KIND_COUNT when the image holds none. */
static uint8_t kind_marked(uint8_t mark)
{
    uint8_t kind = 0;
    while (kind != FILTER_KIND_COUNT && settings_filter_mark(kind) != mark) {
        kind++;
    }
    return kind;
}

void settings_load(void)
{
    kept = (uint8_t)store_load((uint8_t *)settings());
    if (kept >= KEPT_GOOD && calibration_check(&settings()->calibration).why != CALIBRATION_GOOD) {
        kept = KEPT_DAMAGED;
    }
    if (kept < KEPT_GOOD) {
        settings_defaults();
    } else {
        settings()->choice.filter = kind_marked(settings()->choice.mark);
        if (settings()->choice.filter == FILTER_KIND_COUNT) {
            settings_take_filter(0);
            kept = KEPT_NO_FILTER;
        }
        settings_follow();
    }
}
