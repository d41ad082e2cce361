/* Functions of libm that glibc 2.29 made anew under the same names. Shared libraries linked with them would need glibc 2.29; these call the
   ones before, whose values are the same and which set errno too. With them the library needs glibc 2.25 alone. */
#if defined __x86_64__
#define OLDEST "GLIBC_2.2.5"
#elif defined __aarch64__
#define OLDEST "GLIBC_2.17"
#endif

double older_exp(double);
double older_exp2(double);
double older_log(double);
double older_log2(double);
double older_pow(double, double);
__asm__(".symver older_exp, exp@" OLDEST);
__asm__(".symver older_exp2, exp2@" OLDEST);
__asm__(".symver older_log, log@" OLDEST);
__asm__(".symver older_log2, log2@" OLDEST);
__asm__(".symver older_pow, pow@" OLDEST);

double exp(double x) { return older_exp(x); }
double exp2(double x) { return older_exp2(x); }
double log(double x) { return older_log(x); }
double log2(double x) { return older_log2(x); }
double pow(double x, double y) { return older_pow(x, y); }
