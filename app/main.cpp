// The command line: finds the command, runs it, turns errors into exit codes.

#include <cstdio>

int main() {
    std::puts("obscura 0.1.0");
    return 0;
}
