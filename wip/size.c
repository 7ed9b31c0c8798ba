#include "filter.h"
#include <avr/io.h>
volatile uint8_t which; volatile int16_t z; volatile int32_t out; volatile uint32_t r;
const filter_law_t *const laws[] PROGMEM = { LAWS };
static filter_t f; char checksize[sizeof(filter_t)];
int main(void){ const filter_law_t *law=(const filter_law_t*)pgm_read_ptr(&laws[which]);
 filter_config_t c=filter_defaults(law,1000); c.value[which]=(int32_t)r; if(filter_init(&f,law,&c)) return 1; 
 for(;;){ if(which==3) filter_set_noise(&f,r); if(which==7) filter_reset_step(&f,z,which);  out= which==5? filter_missing(&f):filter_update(&f,z); } }
