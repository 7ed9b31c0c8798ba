#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <stdint.h>
#include <stdbool.h>
static uint32_t rs; static uint32_t rnd(void){uint32_t v=rs;v^=v<<13;v^=v>>17;v^=v<<5;return rs=v;}
static double gauss(void){double s=0;for(int i=0;i<12;i++)s+=rnd()/4294967296.0;return s-6;}
/* supplied by each side */
static int n_params(int kind); static void param_range(int kind,int i,int64_t*min,int64_t*max,int*zero);
static bool begin(int kind,uint16_t rate,const int64_t*v); /* v[i] = INT64_MIN: default */
static int32_t update(int16_t z); static int32_t missing(void); static void set_noise(uint32_t r); static void reset_(int16_t z); static void restart_(void); static void show(int32_t x);
static int draw(int kind,int64_t*v,int how){int n=n_params(kind);for(int i=0;i<n;i++){int64_t a,b;int z;param_range(kind,i,&a,&b,&z);uint32_t w=rnd();uint32_t u=rnd();if(how==0||w%3==0)v[i]=INT64_MIN;else if(w%3==1){uint64_t span=(uint64_t)(b-a)+1;uint32_t sh=(w>>8)&31;uint64_t d=((uint64_t)u>>sh)%span;v[i]=a+(int64_t)d; if(z&&(w>>16)%8==0)v[i]=0;}else {v[i]=a+(int64_t)(u%(uint64_t)(b-a+1));}}return n;}
static const char*names[]={"kf","lrf","sprf","soft","sprf_paper","pbf","shrf","af","synth","synth_opt","synth_plus","adaptive","kf3","auto"};
int main(int argc,char**argv){int kind=atoi(argv[1]);uint32_t seed=(uint32_t)atoi(argv[2]);int runs=atoi(argv[3]);int dmg=argc>4?atoi(argv[4]):7;(void)names;
 static const uint16_t rates[]={125,250,500,1000,2000,4000,8000,60,313};
 for(int run=0;run<runs;run++){rs=seed*7919u+(uint32_t)run*104729u+1u;for(int i=0;i<10;i++)rnd();uint16_t rate=rates[rnd()%9];int64_t v[8];draw(kind,v,run%3==0?0:1);
  if(!begin(kind,rate,v)){printf("refused %d\n",run);continue;}
  printf("run %d rate %u\n",run,rate);double pos=(double)(int)(rnd()%2000)-1000,vel=0;double sig=0.5+(rnd()%1000)/100.0;int outl=(int)(rnd()%4)*5;int big=rnd()%5==0;
  for(int k=0;k<1500;k++){uint32_t a=rnd();vel=vel*0.98+gauss()*(big?20:0.3);pos+=vel;if(pos>4000||pos<-4000){pos=pos>0?4000:-4000;vel=0;}
   if(a%997==0)pos+=(int)(a>>16)%2000-1000;
   double z=pos+gauss()*sig;if((int)((a>>8)%100)<outl)z+=(int)((a>>16)%6000)-3000;if((a>>3)%1500==0)z=(a&1)?32767:-32768;
   if(z>32767)z=32767;if(z<-32768)z=-32768;int32_t x;
   if((dmg&1)&&a%211==0){int n=(int)(rnd()%30)+1;for(int j=0;j<n;j++){x=missing();show(x);pos+=vel;}}
   if((dmg&2)&&a%503==0){uint32_t w1=rnd(),w2=rnd();set_noise(w1>>(8+w2%20));}
   if((dmg&4)&&a%701==0){reset_((int16_t)z);}
   if((dmg&4)&&a%907==0){restart_();}
   x=update((int16_t)z);show(x);} }
 return 0;}
