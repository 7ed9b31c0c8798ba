#include "support/roles.h"

#include "tracker.h"

#include <stdio.h>
#include <string.h>

/* The first of the list whose traits among these are the wanted ones. */
static filter_kind_t first(uint8_t among, uint8_t wanted)
{
    for (int kind = 0; kind < FILTER_KIND_COUNT; kind++) {
        if ((filter_listed((filter_kind_t)kind)->traits & among) == wanted) {
            return (filter_kind_t)kind;
        }
    }
    return FILTER_KIND_COUNT;
}

filter_kind_t plain_kind(void)
{
    return first(LAW_COVARIANCE | LAW_GATED, LAW_COVARIANCE);
}

filter_kind_t robust_kind(void)
{
    return first(LAW_COVARIANCE | LAW_GATED, LAW_COVARIANCE | LAW_GATED);
}

static filter_kind_t extreme(bool most)
{
    int found = 0;
    for (int kind = 1; kind < FILTER_KIND_COUNT; kind++) {
        uint16_t cycles = filter_worst_cycles(filter_listed((filter_kind_t)kind));
        uint16_t so_far = filter_worst_cycles(filter_listed((filter_kind_t)found));
        if (most ? cycles > so_far : cycles < so_far) {
            found = kind;
        }
    }
    return (filter_kind_t)found;
}

filter_kind_t light_kind(void)
{
    return extreme(false);
}

filter_kind_t slowest_kind(void)
{
    return extreme(true);
}

uint8_t parameter_named(filter_kind_t kind, const char *name)
{
    const filter_law_t *law = filter_listed(kind);
    for (uint8_t i = 0; i < filter_parameter_count(law); i++) {
        if (strcmp(filter_parameter(law, i)->words, name) == 0) {
            return i;
        }
    }
    return FILTER_PARAMETERS_MAX;
}

filter_kind_t kind_with(const char *parameter)
{
    int kind = 0;
    while (kind < FILTER_KIND_COUNT && parameter_named((filter_kind_t)kind, parameter) == FILTER_PARAMETERS_MAX) {
        kind++;
    }
    return (filter_kind_t)kind;
}

static filter_kind_t default_kind(void)
{
    return DEFAULT_KIND;
}

static const struct {
    const char *word;
    filter_kind_t (*kind)(void);
} roles[] = { { "{default}", default_kind },
              { "{plain}", plain_kind },
              { "{robust}", robust_kind },
              { "{light}", light_kind },
              { "{slowest}", slowest_kind } };
enum { ROLES = sizeof roles / sizeof roles[0], TEXTS = 8, TEXT_SIZE = 600 };

/* The role whose word the text begins with; ROLES: none. */
static size_t role_at(const char *text)
{
    size_t role = 0;
    while (role < ROLES && strncmp(text, roles[role].word, strlen(roles[role].word)) != 0) {
        role++;
    }
    return role;
}

const char *by_role(const char *text)
{
    static char texts[TEXTS][TEXT_SIZE];
    static size_t next;
    char *out = texts[next++ % TEXTS];
    size_t length = 0;
    while (*text != '\0' && length + 16 < TEXT_SIZE) {
        size_t role = role_at(text);
        if (role == ROLES) {
            out[length++] = *text++;
        } else {
            length += (size_t)snprintf(out + length, 16, "%s", filter_listed_name(roles[role].kind()));
            text += strlen(roles[role].word);
        }
    }
    out[length] = '\0';
    return out;
}
