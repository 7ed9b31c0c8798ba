#include "filter_any.h"
#include "filter_parameter.h"
#include "script.h"
static const filter_kind_t kinds[]={FILTER_KIND_kf,FILTER_KIND_lrf,FILTER_KIND_sprf,FILTER_KIND_soft,FILTER_KIND_sprf_paper,FILTER_KIND_pbf,FILTER_KIND_shrf,FILTER_KIND_af,FILTER_KIND_synth,FILTER_KIND_synth_opt,FILTER_KIND_synth_plus,FILTER_KIND_adaptive,FILTER_KIND_kf3,FILTER_KIND_auto};
static filter_any_t f;static uint16_t the_rate;static uint16_t part;static int quarters,nmiss;
static const filter_parameter_t*par(int k,int i){return filter_any_descriptor(kinds[k])->parameters+i;}
static int n_params(int k){return filter_any_descriptor(kinds[k])->parameter_count;}
static void param_range(int k,int i,int64_t*a,int64_t*b,int*z){const filter_parameter_t*p=par(k,i);*a=p->min;*b=p->max;*z=p->zero_means_off;}
static bool begin(int k,uint16_t rate,const int64_t*v){filter_any_config_t c;filter_any_defaults(kinds[k],&c,rate);for(int i=0;i<n_params(k);i++)if(v[i]!=INT64_MIN)filter_parameter_set(&c,par(k,i),(uint32_t)v[i]);the_rate=rate;quarters=nmiss=0;memset(&f,0,sizeof f);return filter_any_init(&f,kinds[k],&c);}
static int32_t last;
static int32_t update(int16_t z){quarters=0;nmiss=0;return last=filter_any_update(&f,z);}
static int32_t missing(void){int passed=0;part=(uint16_t)(part+400);if(nmiss==0)part=200;for(;part>=the_rate;passed++)part=(uint16_t)(part-the_rate);nmiss++;quarters+=passed;if(quarters>=4){quarters=4;return last;}
 if(nmiss==1)filter_any_gap(&f);for(int i=0;i<passed;i++)filter_any_damp(&f);return last=filter_any_coast(&f);}
static void set_noise(uint32_t r){filter_any_set_noise(&f,r);}
static void reset_(int16_t z){filter_any_reset(&f,z);quarters=nmiss=0;}
static void restart_(void){filter_any_restart(&f);quarters=nmiss=0;}
static void show(int32_t x){filter_probe_t p;filter_any_probe(&f,&p);uint8_t fl=filter_any_flags(&f);
 printf("%d %u %d %u %u %u\n",x,fl&~8u,p.rate_lsb_q16,p.p_lsb2_q8,p.gate_lsb2_q8,p.gain_uq16);}
