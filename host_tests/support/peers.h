/*
 * What people put behind an accelerometer, to compare our filters with: an exponential mean (EMA), the same behind a
 * median of three or five or a Hampel filter, and the 1-euro filter (Casiez, Roussel, Vogel: CHI 2012). One axis, in
 * double; they take every sample as it comes, know nothing of gaps and rails, and no noise is estimated for them. Also
 * built for the chip, where double is float, to be timed there.
 *
 * EMA: one cut-off for all rates, weight 1 - exp(-2 pi cut-off / rate). Median: of the last 3 or 5 samples. Hampel: a
 * sample more than 3 scaled median deviations (1.4826 x MAD) from the median of the last 7, itself among them, is
 * replaced by that median. 1-euro: the constants of its paper, a value being one LSB. While fewer samples have come, of
 * those.
 */
#ifndef SUPPORT_PEERS_H
#define SUPPORT_PEERS_H

#define PEER_EMA_HZ 4.0 /* why: docs/results/default-filter.md */
#define PEER_SHORT_MEDIAN 3U
#define PEER_MEDIAN 5U
#define PEER_HAMPEL 7U
#define PEER_EURO_HZ 1.0     /* cut-off at rest, and of the slope */
#define PEER_EURO_BETA 0.007 /* Hz for each LSB/s */

typedef enum { PEER_EMA_ALONE, PEER_MEDIAN3_EMA, PEER_MEDIAN_EMA, PEER_HAMPEL_EMA, PEER_EURO, PEERS } peer_kind_t;

typedef struct {
    peer_kind_t kind;
    double rate_hz;
    double weight;                /* of the EMA */
    double seen_lsb[PEER_HAMPEL]; /* newest first */
    unsigned filled;
    double x_lsb;
    double slope_lsb_s;
} peer_t;

const char *peer_name(peer_kind_t kind);

void peer_begin(peer_t *peer, peer_kind_t kind, double rate_hz);

/* One sample in, the estimate out; the first is taken as it is. */
double peer_sample(peer_t *peer, double z_lsb);

#endif
