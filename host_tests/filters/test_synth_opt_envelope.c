/* synth and synth_opt: the sums that the rule for their estimates stands on (support/envelope.h). */
#include "support/filters.h"
#include "support/test.h"

#include <math.h>

/* Sum of the magnitudes of the answer to one sample of 1 of the filter x_e = 2 x1 - x2 with the gain b0. */
static double straight_line_sum(double b0)
{
    double x1 = 0.0;
    double x2 = 0.0;
    double sum = 0.0;
    for (int k = 0; k < 500; k++) {
        double predicted = 2.0 * x1 - x2;
        double x = predicted + b0 * ((k == 0 ? 1.0 : 0.0) - predicted);
        sum += fabs(x);
        x2 = x1;
        x1 = x;
    }
    return sum;
}

TEST(gain_sums_are_as_stated)
{
    TEST_ASSERT_DOUBLE_WITHIN(5e-4, law_facts(FILTER_KIND_synth).envelope.gain_sum, straight_line_sum(0.3));
    TEST_ASSERT_DOUBLE_WITHIN(1.5e-3, law_facts(FILTER_KIND_synth_opt).envelope.gain_sum, straight_line_sum(2.0 / 3.0));
}
