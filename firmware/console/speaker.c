/* When a line may go out. The texts are in reply_lines.c. */
#include "console/speaker.h"

#include "base/notices.h"
#include "base/text.h"
#include "console/reply_lines.h"
#include "output/rows.h"
#include "settings/settings.h"

static bool begun; /* a line of the oldest notice is out */

/* A reply of many lines, which a person should see whole. */
static bool is_read(uint8_t kind)
{
    return kind >= NOTICE_HELP && kind <= NOTICE_LISTING;
}

void speaker_start(void)
{
    begun = false;
}

bool speaker_pass(void)
{
    if (notices_empty() || !text_open((uint8_t)(TEXT_LINE_MAX + SETTINGS_ROW_MAX))) {
        return false;
    }
    const notice_t *notice = notices_oldest();
    reply_progress_t progress = reply_line(notice->kind, notice->argument, !begun);
    if (progress == REPLY_WAITS) {
        return false;
    }
    begun = progress == REPLY_GOES_ON;
    if (is_read(notice->kind)) {
        rows_hold();
    }
    if (!begun) {
        notices_drop();
    }
    return true;
}
