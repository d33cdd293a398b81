// Starts a command in a console of its own, presses Ctrl-C there after some seconds, and prints the command's exit code, or "still there" where it
// has not ended ten seconds later. Only scripts/try-windows uses it.
// usage: x86_64-w64-mingw32-gcc -municode -o interrupt.exe interrupt.c; interrupt.exe SECONDS COMMAND-LINE
#include <stdio.h>
#include <stdlib.h>
#include <windows.h>

static BOOL WINAPI stay(DWORD event)
{
    return event == CTRL_C_EVENT;
}

int wmain(int count, wchar_t **words)
{
    if (count != 3) return 2;
    HANDLE output = GetStdHandle(STD_OUTPUT_HANDLE);
    FreeConsole();
    if (!AllocConsole()) return 3;
    // A handler is not inherited, so that the command itself takes Ctrl-C as it comes.
    SetConsoleCtrlHandler(stay, TRUE);
    STARTUPINFOW start = {.cb = sizeof start};
    PROCESS_INFORMATION started;
    if (!CreateProcessW(NULL, words[2], NULL, NULL, FALSE, 0, NULL, NULL, &start, &started)) return 4;
    Sleep(1000 * _wtoi(words[1]));
    char said[64];
    DWORD code = 0, written;
    if (!GetExitCodeProcess(started.hProcess, &code) || code != STILL_ACTIVE) {
        int length = snprintf(said, sizeof said, "ended before Ctrl-C with %lu\n", code);
        WriteFile(output, said, length, &written, NULL);
        return 5;
    }
    GenerateConsoleCtrlEvent(CTRL_C_EVENT, 0);
    if (WaitForSingleObject(started.hProcess, 10000) != WAIT_OBJECT_0) {
        WriteFile(output, "still there\n", 12, &written, NULL);
        return 6;
    }
    GetExitCodeProcess(started.hProcess, &code);
    int length = snprintf(said, sizeof said, "exit code %lx\n", code);
    WriteFile(output, said, length, &written, NULL);
    return 0;
}
