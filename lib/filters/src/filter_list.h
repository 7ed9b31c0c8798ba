/* The one list of filters: X(name). Adding a filter adds a word here. */
#ifndef FILTER_LIST_H
#define FILTER_LIST_H

#include "kf.h"
#include "lrf.h"
#include "soft.h"
#include "sprf.h"
#include "synth.h"

#define FILTER_LIST(X) \
    X(kf)              \
    X(sprf)            \
    X(synth)           \
    X(lrf)             \
    X(soft)

#endif
