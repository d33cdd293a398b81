// Starts a command in a console of its own, presses Ctrl-C there after eight seconds, and ends with the command's exit code; with 8 where it ended before,
// with 9 where it has not ended ten seconds later. Only scripts/try-windows uses it.
#include <windows.h>

static BOOL WINAPI stay(DWORD event)
{
    return event == CTRL_C_EVENT;
}

int wmain(int count, wchar_t **words)
{
    STARTUPINFOW start = {.cb = sizeof start};
    PROCESS_INFORMATION started;
    DWORD code;
    FreeConsole();
    // A handler is not inherited, so that the command itself takes Ctrl-C as it comes.
    if (count != 2 || !AllocConsole() || !SetConsoleCtrlHandler(stay, TRUE)) return 2;
    if (!CreateProcessW(NULL, words[1], NULL, NULL, FALSE, 0, NULL, NULL, &start, &started)) return 4;
    if (WaitForSingleObject(started.hProcess, 8000) != WAIT_TIMEOUT) return 8;
    GenerateConsoleCtrlEvent(CTRL_C_EVENT, 0);
    if (WaitForSingleObject(started.hProcess, 10000) != WAIT_OBJECT_0) return 9;
    GetExitCodeProcess(started.hProcess, &code);
    return code;
}
