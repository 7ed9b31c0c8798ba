/*
 * All replies. A line here is a kind of notice (notices.h) and its text, into which the console puts the values V_...
 * (console/reply_texts.h); `make texts` packs it. COMMAND: what a person types for it comes first; run_verb of
 * console/commands.c does what else it asks for. Other rooms post the kinds, so the list is in the lowest one.
 *
 * The order: first the banner, then the commands, of which NOISE to CAL6 are measurements and HELP to LISTING have many
 * lines, for a person to read. SETTING to TOO_SLOW are setting_answer_t, ILLEGAL to BUSY are refusals.
 */
#ifndef REPLIES_H
#define REPLIES_H

/* clang-format off */
#define REPLIES(REPLY, COMMAND) \
    REPLY(BANNER, V_WHO V_LINE \
      "reset: " V_CAUSE V_LINE \
      V_SETTINGS V_LINE \
      "settings: " V_KEPT V_LINE \
      "type help, or mode plot for the Arduino plotter" V_LINE \
      V_SENSOR V_LINE \
      V_HEADER) \
    COMMAND(STOPPED, "stop", "stopped") \
    COMMAND(GOING, "go", "going") \
    COMMAND(SAVED, "save", "saved") \
    COMMAND(LOADED, "load", "settings: " V_KEPT V_LINE_IF_CSV V_HEADER) \
    COMMAND(DEFAULTS, "defaults", "settings: defaults" V_LINE_IF_CSV V_HEADER) \
    COMMAND(ODR, "odr", "odr " V_MEASURED " Hz, " V_OFF " % from " V_RATE " Hz") \
    COMMAND(NOISE, "noise", "noise " V_AXIS " " V_RMS " LSB rms, R " V_R " LSB^2" V_AGAIN) \
    COMMAND(SELFTEST, "selftest", "selftest " V_AXIS " " V_SHIFT " LSB, " V_LIMITS V_AGAIN) \
    COMMAND(TARE, "tare", V_LISTED V_LINE \
      V_KEEP) \
    COMMAND(CAL, "cal", V_LISTED V_LINE \
      V_KEEP) \
    COMMAND(CAL6, "cal6", "cal6: residual " V_RESIDUAL " mg" V_LINE \
      V_LISTED V_AGAIN V_LINE \
      V_KEEP) \
    COMMAND(VERSION, "version", V_WHO) \
    COMMAND(HELP, "help", V_SETTING_NAME ": " V_LEGAL V_AGAIN V_LINE \
      V_VERBS "; NAME VALUE sets") \
    COMMAND(STATUS, "status", "state " V_STATE ", fault " V_SUBJECT ", rate " V_RATE " Hz, measured " V_MEASURED \
      " Hz, uptime s " V_COUNT V_CHOICES V_LINE \
      "samples " V_COUNT ", gated " V_COUNT ", reacquired " V_COUNT ", clipped " V_COUNT V_LINE \
      "rows " V_COUNT ", dropped " V_COUNT ", held " V_COUNT ", serial bytes lost " V_SERIAL_LOST \
      ", lines refused " V_COUNT V_LINE \
      "lost " V_COUNT ", late " V_COUNT ", drained " V_COUNT ", stuck " V_COUNT ", restarts " V_COUNT V_LINE \
      "not acknowledged " V_COUNT ", arbitration lost " V_COUNT ", bus errors " V_COUNT ", timeouts " V_COUNT V_LINE \
      "readings torn " V_COUNT ", empty " V_COUNT ", overruns " V_COUNT ", storms " V_COUNT V_LINE \
      "reset: " V_CAUSE) \
    COMMAND(LISTING, "settings", V_LISTED V_AGAIN) \
    REPLY(SETTING, V_SETTING V_SETTING_NOTE) \
    REPLY(ILLEGAL, "refused 4: " V_SETTING_NAME " is one of " V_LEGAL) \
    REPLY(TOO_SLOW, "refused 5: takes " V_CYCLES " of " V_LEFT " cycles a sample") \
    REPLY(UNKNOWN, "refused 1: unknown command (type help)") \
    REPLY(TOO_LONG, "refused 2: line too long") \
    REPLY(GARBAGE, "refused 3: illegal characters") \
    REPLY(BUSY, "refused 10: busy measuring") \
    REPLY(FAULT_BEGIN, "fault " V_SUBJECT ": " V_FAULT_WORDS) \
    REPLY(FAULT_END, "fault " V_SUBJECT " over: after " V_OUTAGE_MS " ms, " V_OUTAGE_LOST \
      " lost, sensor at 0x" V_OUTAGE_ADDRESS) \
    REPLY(LIMITED, "limited: q by r")
/* clang-format on */

#endif
