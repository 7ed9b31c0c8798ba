/* Settings across power cycles: the store's image of them, and how loading it went. Main only. */
#ifndef SETTINGS_KEPT_H
#define SETTINGS_KEPT_H

#include <stdbool.h>
#include <stdint.h>

/* Where the settings come from, in the order of the texts for it (reply_texts.h). */
typedef enum {
    KEPT_DAMAGED,       /* defaults: no saved copy is intact */
    KEPT_EMPTY,         /* defaults: nothing was saved */
    KEPT_OTHER_VERSION, /* defaults: saved by firmware with another record format */
    KEPT_GOOD,          /* as last saved */
    KEPT_OLDER,         /* one copy is damaged: settings of the other one, which may be the older */
    KEPT_NO_FILTER,     /* as saved, but this image does not have the filter: its first one, with shipped parameters */
    KEPT_UNREAD,        /* defaults: requested by D4, or after repeated resets */
    KEPT_CALIBRATION    /* calibration as saved, else defaults: saved by a version that stores other things beside it */
} kept_t;

/*
 * Loads the saved settings, else defaults; once at start-up, before any save. May wait 3.4 ms for an EEPROM byte that
 * was being written at a reset.
 */
void settings_load(void);

/* Takes defaults in place of the saved settings, which are left alone; after settings_load. */
void settings_unread(void);

/* kept_t of the settings in force since settings_load. */
uint8_t settings_kept(void);

#endif
