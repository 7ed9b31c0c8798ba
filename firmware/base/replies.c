/* The queue of replies and when a line may go out. The words are in reply_lines.c. */
#include "base/replies.h"

#include "base/text.h"
#include "console/reply_lines.h"
#include "settings/settings.h"

enum { QUEUE_LENGTH = 8 };

typedef struct {
    uint8_t kind;
    uint8_t argument;
} reply_t;

static reply_t queue[QUEUE_LENGTH];
static uint8_t count;
static bool begun; /* the first of them: a line of it is out */

void replies_start(void)
{
    count = 0;
    begun = false;
}

bool replies_room(void)
{
    return count < QUEUE_LENGTH;
}

bool replies_hold(reply_kind_t first, reply_kind_t last)
{
    for (uint8_t i = 0; i < count; i++) {
        if (queue[i].kind >= (uint8_t)first && queue[i].kind <= (uint8_t)last) {
            return true;
        }
    }
    return false;
}

bool replies_empty(void)
{
    return count == 0;
}

bool replies_add(reply_kind_t kind, uint8_t argument)
{
    if (!replies_room()) {
        return false;
    }
    queue[count].kind = (uint8_t)kind;
    queue[count].argument = argument;
    count++;
    return true;
}

bool replies_pass(void)
{
    if (count == 0 || !text_open((uint8_t)(TEXT_LINE_MAX + SETTINGS_ROW_MAX))) {
        return false;
    }
    reply_progress_t progress = reply_line(queue[0].kind, queue[0].argument, !begun);
    if (progress == REPLY_WAITS) {
        return false;
    }
    begun = progress == REPLY_GOES_ON;
    if (!begun) {
        count--;
        for (uint8_t i = 0; i < count; i++) {
            queue[i] = queue[i + 1u];
        }
    }
    return true;
}
