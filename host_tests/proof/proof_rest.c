/* A rest: any readings in any state of it, after any number of them; the sums' documented bounds. */
#include "eva.h"

#include "rest.h"

#define SUM(v) (-32640 <= (v) <= 32385)
#define FIRST(v) (-REST_LIMIT_LSB <= (v) <= REST_LIMIT_LSB)

/* What a mean at rest is at most, LSB in Q4: the calibration takes it. */
/*@ requires SUM(axis->sum_lsb) && FIRST(axis->first_lsb);
    ensures -32440 <= \result <= 32440;
*/
int16_t rest_mean_lsb_q4(const rest_axis_t *axis);

/*@ requires SUM(axis->sum_lsb) && axis->squares_lsb2 <= 4177920;
    assigns \result \from *axis;
    ensures below: \result < 4194304;
*/
uint32_t rest_variance_lsb2_q8(const rest_axis_t *axis);

/*@ ensures rest->samples == 0 && !rest->moved; */
void rest_start(rest_t *rest);

#include "rest.c"

/* After so many readings; the first of a rest that has moved may be anywhere. */
static void any_rest(rest_t *rest, uint8_t samples)
{
    int16_t later = (int16_t)(samples == 0U ? 0 : samples - 1);
    int16_t half = (samples < HALF) ? 0 : HALF - 1;
    for (uint8_t i = 0; i < (uint8_t)AXES; i++) {
        rest->axes[i].squares_lsb2 = ANY_U32(0, (uint32_t)later * 16384U);
        rest->axes[i].sum_lsb = ANY_S16(-128 * later, 127 * later);
        rest->axes[i].half_lsb = ANY_S16(-128 * half, 127 * half);
        rest->axes[i].first_lsb = ANY_Z();
    }
    rest->samples = samples;
    rest->moved = ANY_BOOL();
}

void proof_rest_start(void)
{
    rest_t rest;
    rest_start(&rest);
}

/*
 * Number by number, each from any sums of so many: with the next number's bounds afterwards. The casts take the low
 * byte of what is found too far just behind.
 * Options: -no-warn-signed-downcast -eva-subdivide-non-linear 20 -eva-split-return-function rest_add:full
 */
void proof_rest_add(void)
{
    for (uint16_t before = 0; before < REST_SAMPLES; before++) {
        rest_t rest;
        any_rest(&rest, (uint8_t)before);
        const int16_t lsb[3] = { ANY_Z(), ANY_Z(), ANY_Z() };
        bool last = rest_add(&rest, lsb);
        int16_t sum = rest.axes[2].sum_lsb;
        int16_t half = rest.axes[2].half_lsb;
        uint32_t squares = rest.axes[2].squares_lsb2;
        //@ check first: before != 0 || (sum == 0 && squares == 0);
        //@ check sums: before == 0 || (-128 * before <= sum <= 127 * before && squares <= 16384 * before);
        //@ check first_half: -16256 <= half <= 16129 && (before >= 127 || half == 0);
        //@ check counted: rest.samples == before + 1 || (before == 255 && rest.samples == 0 && last != 0);
        bool moved = rest.moved;
        //@ check told: moved == 0 || last != 0;
    }
}

void proof_rest_mean_lsb_q4(void)
{
    rest_axis_t axis = { ANY_U32(0, 4177920), ANY_S16(-32640, 32385), ANY_S16(-16256, 16129),
                         ANY_S16(-REST_LIMIT_LSB, REST_LIMIT_LSB) };
    (void)rest_mean_lsb_q4(&axis);
}

void proof_rest_variance_lsb2_q8(void)
{
    rest_axis_t axis = { ANY_U32(0, 4177920), ANY_S16(-32640, 32385), ANY_S16(-16256, 16129), ANY_Z() };
    (void)rest_variance_lsb2_q8(&axis);
}

void proof_rest_still(void)
{
    rest_t rest;
    any_rest(&rest, 0);
    bool still = rest_still(&rest, ANY_U16(0, UINT16_MAX));
    for (uint16_t samples = 1; samples <= REST_SAMPLES; samples++) {
        any_rest(&rest, (uint8_t)(samples - 1U));
        still = rest_still(&rest, ANY_U16(0, UINT16_MAX));
    }
    rest.moved = true;
    still = rest_still(&rest, ANY_U16(0, UINT16_MAX));
    //@ check moved: still == 0;
}
