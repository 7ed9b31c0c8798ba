/* libfixkalman over libfixmatrix and libfixmath, Q16.16. */
#include "fixkalman.h"

#include "peer.h"

PEER_FIX16

static kalman16_uc_t filter;
static kalman16_observation_t observed;

void peer_start(void)
{
    kalman_filter_initialize_uc(&filter, 2);
    kalman_observation_initialize(&observed, 2, 1);
    mf16 *transition = kalman_get_state_transition_uc(&filter);
    transition->data[0][0] = F16(1);
    transition->data[0][1] = F16(1);
    transition->data[1][1] = F16(1);
    mf16 *covariance = kalman_get_system_covariance_uc(&filter);
    covariance->data[0][0] = F16(PEER_R);
    covariance->data[1][1] = F16(PEER_RATE_VARIANCE);
    kalman_get_system_process_noise_uc(&filter)->data[1][1] = F16(PEER_Q);
    kalman_get_observation_transformation(&observed)->data[0][0] = F16(1);
    kalman_get_observation_process_noise(&observed)->data[0][0] = F16(PEER_R);
}

void peer_step(void)
{
    kalman_predict_uc(&filter);
    kalman_get_observation_vector(&observed)->data[0][0] = z;
    kalman_correct_uc(&filter, &observed);
    x = kalman_get_state_vector_uc(&filter)->data[0][0];
}
