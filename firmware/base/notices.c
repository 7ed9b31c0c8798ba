/* A short queue: whoever finds it full posts the notice again. */
#include "base/notices.h"

enum { QUEUE_LENGTH = 8 };

static notice_t queue[QUEUE_LENGTH];
static uint8_t count;

void notices_start(void)
{
    count = 0;
}

bool notices_room(void)
{
    return count < QUEUE_LENGTH;
}

bool notices_hold(notice_kind_t first, notice_kind_t last)
{
    for (uint8_t i = 0; i < count; i++) {
        if (queue[i].kind >= (uint8_t)first && queue[i].kind <= (uint8_t)last) {
            return true;
        }
    }
    return false;
}

bool notices_empty(void)
{
    return count == 0;
}

bool notices_add(notice_kind_t kind, uint8_t argument)
{
    if (!notices_room()) {
        return false;
    }
    queue[count].kind = (uint8_t)kind;
    queue[count].argument = argument;
    count++;
    return true;
}

const notice_t *notices_oldest(void)
{
    return &queue[0];
}

void notices_drop(void)
{
    count--;
    for (uint8_t i = 0; i < count; i++) {
        queue[i] = queue[i + 1u];
    }
}
