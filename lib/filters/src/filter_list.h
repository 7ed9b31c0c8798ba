/*
 * The one list of filters: X(name). Adding a filter adds a word here; the firmware starts with the first. A build that
 * has no room for all says which it wants: -D'FILTER_LIST(X)=X(kf) X(sprf)'.
 */
#ifndef FILTER_LIST_H
#define FILTER_LIST_H

#include "adaptive.h"
#include "af.h"
#include "auto.h"
#include "kf.h"
#include "kf3.h"
#include "lrf.h"
#include "pbf.h"
#include "shrf.h"
#include "soft.h"
#include "sprf.h"
#include "sprf_paper.h"
#include "synth.h"
#include "synth_opt.h"
#include "synth_plus.h"

#ifndef FILTER_LIST
#define FILTER_LIST(X) \
    X(adaptive)        \
    X(kf)              \
    X(sprf)            \
    X(synth)           \
    X(lrf)             \
    X(soft)            \
    X(sprf_paper)      \
    X(shrf)            \
    X(pbf)             \
    X(af)              \
    X(synth_opt)       \
    X(synth_plus)      \
    X(kf3)             \
    X(auto)
#endif

/* Those that filter_any.c links: fewer where a program over the whole list has no room for all (tests on the chip). */
#ifndef FILTER_LINKED
#define FILTER_LINKED(X) FILTER_LIST(X)
#endif

#endif
