import subprocess,sys,math
names="kf lrf sprf soft sprf_paper pbf shrf af synth synth_opt synth_plus adaptive kf3 auto".split()
kinds=[names.index(a) for a in sys.argv[1].split(",")]; runs=sys.argv[2] if len(sys.argv)>2 else "60"; dmg=sys.argv[3] if len(sys.argv)>3 else "7"
for k in kinds:
    a=subprocess.run(["./old",str(k),"3",runs,dmg],capture_output=True,text=True).stdout.splitlines()
    r=subprocess.run(["./new",str(k),"3",runs,dmg],capture_output=True,text=True); b=r.stdout.splitlines()
    if r.stderr: print(r.stderr[:1500])
    n=0; diffs=0; worst=0; cols=[0]*6; first=None; sq=0; last=''
    flag=0
    for i,(x,y) in enumerate(zip(a,b)):
        if x[0]=='r': 
            last=x
            if x!=y: print(names[k],"structure differs at",i,x,y); break
            continue
        n+=1
        if x!=y:
            diffs+=1
            if first is None and (len(sys.argv)<5 or i%1501>6) : first=(i,last,x,y)
            xs=list(map(int,x.split())); ys=list(map(int,y.split()))
            for c in range(6): cols[c]+= xs[c]!=ys[c]
            d=abs(xs[0]-ys[0])/65536; worst=max(worst,d); sq+=d*d
    print(names[k],len(a),len(b),"rows",n,"differ",diffs,"by column x,flags,rate,p,gate,gain:",cols,"worst",round(worst,5),"rms",round(math.sqrt(sq/max(n,1)),6),first)
