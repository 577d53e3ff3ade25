// data-driven (structure-generic) loop kernel, LANES positions (or variants) at a time; see run.py
#include <math.h>
#include <string.h>
#ifndef LANES
#define LANES 8
#endif
#if LANES == 1
typedef double V; typedef long M;
#define VSEL(c,a,b) ((c)?(a):(b))
static inline V vabs(V a){return fabs(a);}
static inline V bc(double x){return x;}
static inline V ld(const double*p){return *p;} static inline void st(double*p,V v){*p=v;}
#ifdef LIBMVEC
#endif
static inline void vsincos(V a,V*s,V*c){ sincos(a,s,c); }
#else
typedef double V __attribute__((vector_size(8*LANES))); typedef long M __attribute__((vector_size(8*LANES)));
#define VSEL(c,a,b) ((V)(((M)(a)&(c))|((M)(b)&~(c))))
static inline V bc(double x){ return x-(V){}; }
static inline V vabs(V a){ return (V)((M)a & ((M){}+0x7fffffffffffffffL)); }
static inline V ld(const double*p){ V v; memcpy(&v,p,sizeof v); return v; } static inline void st(double*p,V v){ memcpy(p,&v,sizeof v); }
#if LANES == 8
V _ZGVeN8v_sin(V); V _ZGVeN8v_cos(V);
#define VS _ZGVeN8v_sin
#define VC _ZGVeN8v_cos
#elif LANES == 4
V _ZGVdN4v_sin(V); V _ZGVdN4v_cos(V);
#define VS _ZGVdN4v_sin
#define VC _ZGVdN4v_cos
#endif
#ifdef OWNSC
// Cody-Waite reduction + minimax/Taylor polynomials, |x| < ~1e5, error ~1 ulp; no table, no branches
static inline void vsincos(V x,V*s,V*c){
  const V ip=bc(0.63661977236758134308), big=bc(6755399441055744.0);
  V k=(x*ip+big); M ki=(M)k; k=k-big;
  V r=x-k*bc(1.57079632673412561417e+00); r=r-k*bc(6.07710050630396597660e-11); V r0=r; V w=k*bc(2.02226624879595063154e-21); r=r-w; (void)r0;
  V z=r*r;
  V sp=bc(1.58962301576546568060e-10); sp=sp*z+bc(-2.50507477628578072866e-08); sp=sp*z+bc(2.75573136213857245213e-06); sp=sp*z+bc(-1.98412698295895385996e-04); sp=sp*z+bc(8.33333333332211858878e-03); sp=sp*z+bc(-1.66666666666666307295e-01);
  V sn=r+r*z*sp;
  V cp=bc(-1.13585365213876817300e-11); cp=cp*z+bc(2.08757008419747316778e-09); cp=cp*z+bc(-2.75573141792967388112e-07); cp=cp*z+bc(2.48015872888517045348e-05); cp=cp*z+bc(-1.38888888888730564116e-03); cp=cp*z+bc(4.16666666666665929218e-02);
  V cs=bc(1.0)-bc(0.5)*z+z*z*cp;
  M sw=-(ki&1); V a=VSEL(sw,cs,sn), b=VSEL(sw,sn,cs);
  M sgs=(ki&2)<<62, sgc=((ki+1)&2)<<62;
  *s=(V)((M)a^sgs); *c=(V)((M)b^sgc);
}
#else
static inline void vsincos(V a,V*s,V*c){ *s=VS(a); *c=VC(a); }
#endif
#endif
#define MAXJ 16
#ifdef PVAR   // parameters differ per lane: lanes = variants
typedef V CD;
#define BC(x) (x)
#else
typedef double CD;
#define BC(x) bc(x)
#endif
typedef struct { int n, nu, point, jL, jR; int type[MAXJ], par[MAXJ], hasb[MAXJ]; int nL,nR, chL[MAXJ], chR[MAXJ];
  CD C[MAXJ][9], c[MAXJ][3], m[MAXJ], com[MAXJ][3], I[MAXJ][9], xL[3], xR[3], EL[9], ER[9], g[3]; } Mech;
#define FI static inline __attribute__((always_inline))
typedef struct { V x,y,z; } V3;
FI V3 add(V3 a,V3 b){return (V3){a.x+b.x,a.y+b.y,a.z+b.z};}
FI V3 sub(V3 a,V3 b){return (V3){a.x-b.x,a.y-b.y,a.z-b.z};}
FI V3 neg(V3 a){return (V3){-a.x,-a.y,-a.z};}
FI V3 sc(V s,V3 a){return (V3){s*a.x,s*a.y,s*a.z};}
FI V3 cr(V3 a,V3 b){return (V3){a.y*b.z-a.z*b.y,a.z*b.x-a.x*b.z,a.x*b.y-a.y*b.x};}
FI V dt(V3 a,V3 b){return a.x*b.x+a.y*b.y+a.z*b.z;}
typedef struct { V3 X,Y,Z; } R3;     // columns
FI V3 rv(const R3*R,const CD*c){ return add(add(sc(BC(c[0]),R->X),sc(BC(c[1]),R->Y)),sc(BC(c[2]),R->Z)); }
FI V3 rV(const R3*R,V3 v){ return add(add(sc(v.x,R->X),sc(v.y,R->Y)),sc(v.z,R->Z)); }
FI V3 rtV(const R3*R,V3 v){ return (V3){dt(R->X,v),dt(R->Y,v),dt(R->Z,v)}; }
FI R3 rC(const R3*R,const CD*C){ CD a[3]={C[0],C[3],C[6]},b[3]={C[1],C[4],C[7]},c[3]={C[2],C[5],C[8]}; return (R3){rv(R,a),rv(R,b),rv(R,c)}; }
FI V3 bv(const CD*c){ return (V3){BC(c[0]),BC(c[1]),BC(c[2])}; }

FI void fk(const Mech*K,const V*q,R3*R,V3*t){
  for(int k=0;k<K->n;k++){ int p=K->par[k]; R3 S; V3 o;
    if(p<0){ const CD*C=K->C[k]; CD a[3]={C[0],C[3],C[6]},b[3]={C[1],C[4],C[7]},c[3]={C[2],C[5],C[8]}; S=(R3){bv(a),bv(b),bv(c)}; o=bv(K->c[k]); }
    else { S=rC(&R[p],K->C[k]); o=add(t[p],rv(&R[p],K->c[k])); }
    if(K->type[k]==0){ V s,c; vsincos(q[k],&s,&c); R[k].X=add(sc(c,S.X),sc(s,S.Y)); R[k].Y=sub(sc(c,S.Y),sc(s,S.X)); R[k].Z=S.Z; }
    else { R[k]=S; o=add(o,sc(q[k],S.Z)); }
    t[k]=o; } }
FI V3 resid(const Mech*K,const R3*R,const V3*t,V*r){
  V3 xl=add(t[K->jL],rv(&R[K->jL],K->xL)), xr=add(t[K->jR],rv(&R[K->jR],K->xR)); V3 d=sub(xl,xr); r[0]=d.x;r[1]=d.y;r[2]=d.z;
  if(!K->point){ R3 A=rC(&R[K->jL],K->EL),B=rC(&R[K->jR],K->ER); V3 w=add(add(cr(B.X,A.X),cr(B.Y,A.Y)),cr(B.Z,A.Z)); V h=bc(.5); r[3]=h*w.x;r[4]=h*w.y;r[5]=h*w.z; }
  return xl; }
FI void jac(const Mech*K,const R3*R,const V3*t,V3 x,V J[][6]){   // J[k] = column k
  for(int s=0;s<2;s++){ int nc=s?K->nR:K->nL; const int*ch=s?K->chR:K->chL;
    for(int i=0;i<nc;i++){ int k=ch[i]; V3 z=R[k].Z; if(s) z=neg(z); V3 v,w=z;
      if(K->type[k]==0) v=cr(z,sub(x,t[k])); else { v=z; w=(V3){bc(0),bc(0),bc(0)}; }
      J[k][0]=v.x;J[k][1]=v.y;J[k][2]=v.z;J[k][3]=w.x;J[k][4]=w.y;J[k][5]=w.z; } } }
typedef struct { V a[6][6]; M sw[15]; int ip[6]; V inv; V3 r0,r1,r2; } LU;
FI void lu(LU*L,V J[][6],int n){
  if(n==3){ V3 a={J[0][0],J[0][1],J[0][2]},b={J[1][0],J[1][1],J[1][2]},c={J[2][0],J[2][1],J[2][2]}; V3 bcx=cr(b,c); L->inv=bc(1)/dt(a,bcx); L->r0=bcx; L->r1=cr(c,a); L->r2=cr(a,b); return; }
  V(*a)[6]=L->a; for(int i=0;i<6;i++) for(int j=0;j<6;j++) a[i][j]=J[j][i];
#if LANES==1
  for(int k=0;k<6;k++){ int p=k; for(int i=k+1;i<6;i++) if(fabs(a[i][k])>fabs(a[p][k])) p=i; L->ip[k]=p; if(p!=k) for(int j=0;j<6;j++){ V t=a[k][j];a[k][j]=a[p][j];a[p][j]=t; }
    V iv=1/a[k][k]; a[k][k]=iv; for(int i=k+1;i<6;i++){ V f=a[i][k]*iv; a[i][k]=f; for(int j=k+1;j<6;j++) a[i][j]-=f*a[k][j]; } }
#else
  int s=0;
#pragma GCC unroll 6
  for(int k=0;k<6;k++){
#pragma GCC unroll 6
    for(int i=k+1;i<6;i++){ M c=(M)(vabs(a[i][k])>vabs(a[k][k])); L->sw[s++]=c;
#pragma GCC unroll 6
      for(int j=0;j<6;j++){ V x=a[k][j],y=a[i][j]; a[k][j]=VSEL(c,y,x); a[i][j]=VSEL(c,x,y);} }
    V iv=bc(1)/a[k][k]; a[k][k]=iv;
#pragma GCC unroll 6
    for(int i=k+1;i<6;i++){ V f=a[i][k]*iv; a[i][k]=f;
#pragma GCC unroll 6
      for(int j=k+1;j<6;j++) a[i][j]-=f*a[k][j]; } }
#endif
}
FI void lsolve(const LU*L,int n,V*b){
  if(n==3){ V3 v={b[0],b[1],b[2]}; b[0]=L->inv*dt(L->r0,v); b[1]=L->inv*dt(L->r1,v); b[2]=L->inv*dt(L->r2,v); return; }
#if LANES==1
  for(int k=0;k<6;k++){ int p=L->ip[k]; V t=b[k];b[k]=b[p];b[p]=t; }
#else
  int s=0;
  for(int k=0;k<6;k++) for(int i=k+1;i<6;i++){ M c=L->sw[s++]; V x=b[k],y=b[i]; b[k]=VSEL(c,y,x); b[i]=VSEL(c,x,y); }
#endif
  for(int k=0;k<6;k++) for(int i=k+1;i<6;i++) b[i]-=L->a[i][k]*b[k];
  for(int k=5;k>=0;k--){ for(int j=k+1;j<6;j++) b[k]-=L->a[k][j]*b[j]; b[k]=b[k]*L->a[k][k]; } }
FI void lsolveT(const LU*L,int n,V*b){
  if(n==3){ V3 v=add(add(sc(b[0],L->r0),sc(b[1],L->r1)),sc(b[2],L->r2)); b[0]=L->inv*v.x;b[1]=L->inv*v.y;b[2]=L->inv*v.z; return; }
  for(int k=0;k<6;k++){ for(int j=0;j<k;j++) b[k]-=L->a[j][k]*b[j]; b[k]=b[k]*L->a[k][k]; }
  for(int k=5;k>=0;k--) for(int i=k+1;i<6;i++) b[k]-=L->a[i][k]*b[i];
#if LANES==1
  for(int k=5;k>=0;k--){ int p=L->ip[k]; V t=b[k];b[k]=b[p];b[p]=t; }
#else
  int s=15; for(int k=5;k>=0;k--) for(int i=5;i>k;i--){ M c=L->sw[--s]; V x=b[k],y=b[i]; b[k]=VSEL(c,y,x); b[i]=VSEL(c,x,y); }
#endif
}
FI void accel(const Mech*K,const R3*R,const V3*t,const V*qd,const V*qdd,V3*W,V3*AL,V3*A){
  V3 O={bc(0),bc(0),bc(0)};
  for(int k=0;k<K->n;k++){ int p=K->par[k]; V3 z=R[k].Z,zq=sc(qd[k],z),zdd=sc(qdd[k],z);
    if(p<0){ if(K->type[k]==0){W[k]=zq;AL[k]=zdd;A[k]=O;} else {W[k]=O;AL[k]=O;A[k]=zdd;} }
    else { V3 d=sub(t[k],t[p]); V3 a=add(A[p],add(cr(AL[p],d),cr(W[p],cr(W[p],d))));
      if(K->type[k]==0){ W[k]=add(W[p],zq); AL[k]=add(add(AL[p],zdd),cr(W[p],zq)); } else { W[k]=W[p];AL[k]=AL[p]; a=add(a,add(zdd,sc(bc(2),cr(W[p],zq)))); }
      A[k]=a; } } }
// q1[N], u0: nu arrays of stride N ; out: rows of stride N: u(nu) qd(nu) qdd(nu) tau lam(3) wrench(6*n)
void FN(run)(const Mech*K,long N,const double*q1,const double*u0,double w,double al,int its,int level,double*out){
  const int n=K->n,nu=K->nu,m=K->point?3:6;
  for(long b=0;b+LANES<=N;b+=LANES){ V q[MAXJ]; R3 R[MAXJ]; V3 t[MAXJ]; V J[MAXJ][6]; V r[6]; LU L; V3 x;
    q[0]=ld(q1+b); for(int k=0;k<nu;k++) q[k+1]=ld(u0+k*N+b);
    for(int it=0;it<its;it++){ fk(K,q,R,t); x=resid(K,R,t,r); jac(K,R,t,x,J); lu(&L,J+1,m); lsolve(&L,m,r); for(int k=0;k<nu;k++) q[k+1]-=r[k]; }
    for(int k=0;k<nu;k++) st(out+k*N+b,q[k+1]);
    if(!level) continue;
    fk(K,q,R,t); x=add(t[K->jL],rv(&R[K->jL],K->xL)); jac(K,R,t,x,J); lu(&L,J+1,m);
    V qd[MAXJ],qdd[MAXJ]; V3 W[MAXJ],AL[MAXJ],A[MAXJ]; for(int i=0;i<m;i++) r[i]=-bc(w)*J[0][i]; lsolve(&L,m,r); qd[0]=bc(w); for(int k=0;k<nu;k++) qd[k+1]=r[k];
    qdd[0]=bc(al); for(int k=1;k<n;k++) qdd[k]=bc(0); accel(K,R,t,qd,qdd,W,AL,A);
    { V3 dl=rv(&R[K->jL],K->xL),dr=rv(&R[K->jR],K->xR); int l=K->jL,h=K->jR; V3 a=sub(add(A[l],add(cr(AL[l],dl),cr(W[l],cr(W[l],dl)))),add(A[h],add(cr(AL[h],dr),cr(W[h],cr(W[h],dr))))); V3 e=sub(AL[l],AL[h]);
      r[0]=-a.x;r[1]=-a.y;r[2]=-a.z;r[3]=-e.x;r[4]=-e.y;r[5]=-e.z; lsolve(&L,m,r); for(int k=0;k<nu;k++) qdd[k+1]=r[k]; }
    for(int k=0;k<nu;k++){ st(out+(nu+k)*N+b,qd[k+1]); st(out+(2*nu+k)*N+b,qdd[k+1]); }
    if(level<2) continue;
    accel(K,R,t,qd,qdd,W,AL,A); V3 F[MAXJ],Nn[MAXJ]; V3 O={bc(0),bc(0),bc(0)};
    for(int k=0;k<n;k++){ if(!K->hasb[k]){F[k]=O;Nn[k]=O;continue;} V3 d=rv(&R[k],K->com[k]); V3 f=sc(BC(K->m[k]),sub(add(A[k],add(cr(AL[k],d),cr(W[k],cr(W[k],d)))),bv(K->g)));
      V3 lw=rtV(&R[k],W[k]),la=rtV(&R[k],AL[k]); const CD*I=K->I[k]; 
      V3 Iw={BC(I[0])*lw.x+BC(I[1])*lw.y+BC(I[2])*lw.z,BC(I[3])*lw.x+BC(I[4])*lw.y+BC(I[5])*lw.z,BC(I[6])*lw.x+BC(I[7])*lw.y+BC(I[8])*lw.z};
      V3 Ia={BC(I[0])*la.x+BC(I[1])*la.y+BC(I[2])*la.z,BC(I[3])*la.x+BC(I[4])*la.y+BC(I[5])*la.z,BC(I[6])*la.x+BC(I[7])*la.y+BC(I[8])*la.z};
      F[k]=f; Nn[k]=add(rV(&R[k],add(Ia,cr(lw,Iw))),cr(add(t[k],d),f)); }
    V Q[MAXJ]; for(int k=n-1;k>=0;k--){ int p=K->par[k]; if(p>=0){F[p]=add(F[p],F[k]);Nn[p]=add(Nn[p],Nn[k]);} Q[k]=K->type[k]==0?dt(R[k].Z,sub(Nn[k],cr(t[k],F[k]))):dt(R[k].Z,F[k]); }
    for(int k=0;k<nu;k++) r[k]=Q[k+1]; lsolveT(&L,m,r); V tau=Q[0]; for(int i=0;i<m;i++) tau-=J[0][i]*r[i];
    double*o=out+3*nu*N+b; st(o,tau); for(int i=0;i<3;i++) st(o+(1+i)*N,-r[i]);
    V3 fl={r[0],r[1],r[2]}; V3 nl=cr(x,fl); if(!K->point) nl=add(nl,(V3){r[3],r[4],r[5]}); o+=4*N;
    for(int s=0;s<2;s++){ int nc=s?K->nR:K->nL; const int*ch=s?K->chR:K->chL; for(int i=0;i<nc;i++){ int k=ch[i]; V3 f=s?add(F[k],fl):sub(F[k],fl),no=s?add(Nn[k],nl):sub(Nn[k],nl); V3 mo=sub(no,cr(t[k],f)); double*oo=o+6*k*N; st(oo,f.x);st(oo+N,f.y);st(oo+2*N,f.z);st(oo+3*N,mo.x);st(oo+4*N,mo.y);st(oo+5*N,mo.z); } }
  } }

// lanes march together through the positions (lanes = variants): Taylor-2 predictor, `its` Newton steps, vel, acc, reactions; optional table or reduction
#ifdef PVAR
void FN(march)(const Mech*K,long nblk,long np,double h,double q10,const double*ustart,double w,double al,int its,double*red){
  for(long blk=0;blk<nblk;blk++){ const Mech*P=K+blk; const int n=P->n,nu=P->nu; double o[64*3+64][LANES] __attribute__((aligned(64))); double u[MAXJ][LANES],q1[LANES]; V mx=bc(0),mr=bc(0);
    for(int k=0;k<nu;k++) for(int l=0;l<LANES;l++) u[k][l]=ustart[k];
    for(long i=0;i<np;i++){ for(int l=0;l<LANES;l++) q1[l]=q10+i*h;
      FN(run)(P,LANES,q1,(double*)u,w,al,its,2,(double*)o);
      for(int k=0;k<nu;k++){ V a=ld(o[k]),d=ld(o[nu+k])*bc(1/w),dd=(ld(o[2*nu+k])-d*bc(al))*bc(1/(w*w)); st(u[k],a+bc(h)*d+bc(.5*h*h)*dd); }
      V t=vabs(ld(o[3*nu])); mx=VSEL((M)(t>mx),t,mx); 
      for(int k=0;k<n;k++){ double(*r)[LANES]=o+3*nu+4+6*k; V f=ld(r[0])*ld(r[0])+ld(r[1])*ld(r[1])+ld(r[2])*ld(r[2]); mr=VSEL((M)(f>mr),f,mr);} }
    st(red+2*blk*LANES,mx); st(red+(2*blk+1)*LANES,mr); } }
#endif
#if LANES == 1
// dynamic response floor: RK4 on the reduced 1-dof equation, closure solved to convergence in every stage (2 Newton from a linear predictor)
static inline void rhs1(const Mech*K,double th,double om,double tau,double*u,double*thp,double*o,double*a){
  int nu=K->nu; for(int k=0;k<nu;k++) u[k]+=o[nu+k]*(th-*thp);       // o holds du/dtheta of the last solution
  double q=th,oo[256]; FN(run)(K,1,&q,u,1.0,0.0,2,1,oo);               // geometry with unit speed: u, u', u''
  for(int k=0;k<nu;k++){ u[k]=oo[k]; o[nu+k]=oo[nu+k]; } *thp=th;
  FN(run)(K,1,&q,u,om,0.0,0,2,oo); double t0=oo[3*nu]; FN(run)(K,1,&q,u,om,1.0,0,2,oo); *a=(tau-t0)/(oo[3*nu]-t0); }
void FN(rk4)(const Mech*K,long ns,double dt,double tau,double th,double om,const double*u0,double*y){
  int nu=K->nu; double u[MAXJ],o[2*MAXJ]={0},thp=th; for(int k=0;k<nu;k++) u[k]=u0[k];
  for(long i=0;i<ns;i++){ double a1,a2,a3,a4; rhs1(K,th,om,tau,u,&thp,o,&a1); double w2=om+.5*dt*a1; rhs1(K,th+.5*dt*om,w2,tau,u,&thp,o,&a2); double w3=om+.5*dt*a2; rhs1(K,th+.5*dt*w2,w3,tau,u,&thp,o,&a3); double w4=om+dt*a3; rhs1(K,th+dt*w3,w4,tau,u,&thp,o,&a4);
    th+=dt/6*(om+2*w2+2*w3+w4); om+=dt/6*(a1+2*a2+2*a3+a4); }
  y[0]=th; y[1]=om; }
#endif
