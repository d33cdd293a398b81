// Wine 8 has no bcryptprimitives.dll, in which Rust's standard library looks for this one function. Only scripts/try-windows uses it.
#include <windows.h>
#include <ntsecapi.h>

__declspec(dllexport) BOOL WINAPI ProcessPrng(PBYTE bytes, SIZE_T count)
{
    return RtlGenRandom(bytes, (ULONG)count);
}
