#include "filter.h"
#include "script.h"
static const filter_law_t*laws[]={&filter_law_kf,&filter_law_lrf,&filter_law_sprf,&filter_law_soft
,&filter_law_sprf_paper,&filter_law_pbf,&filter_law_shrf,&filter_law_af
,&filter_law_synth,&filter_law_synth_opt,&filter_law_synth_plus
,&filter_law_adaptive
,&filter_law_kf3,&filter_law_auto
#ifdef ALL
,NULL
#endif
};
static filter_t f;
static int n_params(int k){return filter_parameter_count(laws[k]);}
static void param_range(int k,int i,int64_t*a,int64_t*b,int*z){const filter_parameter_t*p=filter_parameter(laws[k],(uint8_t)i);*a=p->min;*b=p->max;*z=p->zero_means_off;}
static bool begin(int k,uint16_t rate,const int64_t*v){filter_config_t c=filter_defaults(laws[k],rate);for(int i=0;i<n_params(k);i++)if(v[i]!=INT64_MIN)c.value[i]=(int32_t)v[i];return filter_init(&f,laws[k],&c)==FILTER_ACCEPTED;}
static int32_t update(int16_t z){return filter_update(&f,z);}
static int32_t missing(void){return filter_missing(&f);}
static void set_noise(uint32_t r){filter_set_noise(&f,r);}
static void reset_(int16_t z){filter_reset(&f,z);}
static void restart_(void){filter_restart(&f);}
static void show(int32_t x){filter_probe_t p;filter_probe(&f,&p);
 printf("%d %u %d %u %u %u\n",x,f.flags&~8u,p.rate_lsb_q16,p.p_lsb2_q8,p.gate_lsb2_q8,p.gain_uq16);}
