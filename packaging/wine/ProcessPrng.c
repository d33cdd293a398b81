// Wine 8 has no bcryptprimitives.dll, in which Rust's standard library looks for this one function. Only scripts/try-windows uses it.
// usage: x86_64-w64-mingw32-gcc -shared -o bcryptprimitives.dll ProcessPrng.c -ladvapi32
#include <windows.h>

BOOLEAN NTAPI SystemFunction036(PVOID bytes, ULONG count);

__declspec(dllexport) BOOL WINAPI ProcessPrng(PBYTE bytes, SIZE_T count)
{
    while (count > 0) {
        ULONG part = count > 0x10000000 ? 0x10000000 : (ULONG)count;
        if (!SystemFunction036(bytes, part)) return FALSE;
        bytes += part;
        count -= part;
    }
    return TRUE;
}
