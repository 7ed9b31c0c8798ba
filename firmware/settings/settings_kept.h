/* Settings over power cycles: the store's image of them, and what became of it. Main only. */
#ifndef SETTINGS_KEPT_H
#define SETTINGS_KEPT_H

#include <stdbool.h>
#include <stdint.h>

/* What the settings began as, in the order of the texts for it (reply_texts.h). */
typedef enum {
    KEPT_DAMAGED,       /* defaults: no saved copy is whole */
    KEPT_EMPTY,         /* defaults: nothing was saved */
    KEPT_OTHER_VERSION, /* defaults: saved by firmware that keeps records of another form */
    KEPT_GOOD,          /* as saved last */
    KEPT_OLDER,         /* one copy is damaged: the other's set, which may be the older */
    KEPT_NO_FILTER,     /* as saved, but this image does not hold the filter: its first, with shipped parameters */
    KEPT_UNREAD,        /* defaults: asked for by D4 or after resets again and again */
    KEPT_CALIBRATION    /* calibration as saved, else defaults: saved by a version that keeps other things beside it */
} kept_t;

/*
 * Settings as saved, else defaults; once at start-up, before a save. May wait 3.4 ms for a byte of EEPROM that was
 * being written when a reset came.
 */
void settings_load(void);

/* Defaults in place of the saved settings, which are left alone; after settings_load. */
void settings_unread(void);

/* kept_t of what is in force since settings_load. */
uint8_t settings_kept(void);

#endif
