/* The replies that are lists: help, status, legal values. Lines as in reply_lines.h. */
#ifndef REPLY_LISTS_H
#define REPLY_LISTS_H

#include <stdint.h>

#include "flash.h"
#include "reply_lines.h"

/* Name of a setting (REPLY_FILTER to before REPLY_SETTINGS_END) as it is typed. */
flash_text_t reply_setting_name(uint8_t setting);

/* A filter and a legal rate in a reply's argument. */
uint8_t reply_combination(uint8_t filter, uint16_t rate_dhz);

reply_progress_t reply_too_slow_line(uint8_t combination);
reply_progress_t reply_help_line(uint8_t line);
reply_progress_t reply_status_line(uint8_t line);

/* The legal values of the setting whose reply_kind_t is given. */
reply_progress_t reply_refused_line(uint8_t setting);

#endif
