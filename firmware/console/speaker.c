/* When a line may go out. The texts are in reply_lines.c. */
#include "console/speaker.h"

#include "base/notices.h"
#include "base/text.h"
#include "console/reply_lines.h"
#include "output/rows.h"
#include "settings/settings.h"

/* A reply of many lines, which a person should see whole. */
static bool is_read(uint8_t kind)
{
    return kind >= NOTICE_HELP && kind <= NOTICE_LISTING;
}

bool speaker_pass(void)
{
    if (notices_empty() || !text_open((uint8_t)(TEXT_LINE_MAX + SETTINGS_ROW_MAX))) {
        return false;
    }
    const notice_t *notice = notices_oldest();
    if (!reply_line(notice->kind, notice->argument)) {
        return false;
    }
    if (is_read(notice->kind)) {
        rows_hold();
    }
    if (reply_ended()) {
        notices_drop();
    }
    return true;
}
