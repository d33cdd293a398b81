// Holds a file open so that no other program may write, rename or delete it, until it is killed. Only scripts/try-windows uses it.
// usage: x86_64-w64-mingw32-gcc -municode -o hold.exe hold.c; hold.exe FILE
#include <stdio.h>
#include <windows.h>

int wmain(int count, wchar_t **words)
{
    if (count != 2) return 2;
    HANDLE file = CreateFileW(words[1], GENERIC_READ, 0, NULL, OPEN_EXISTING, FILE_ATTRIBUTE_NORMAL, NULL);
    if (file == INVALID_HANDLE_VALUE) return 1;
    puts("held");
    fflush(stdout);
    Sleep(INFINITE);
    return 0;
}
