// Preloaded by test.sh: nothing is ever unloaded, so that the leak checker can still name the driver that a leak lies in.
// Without it such leaks are "<unknown module>", which no suppression matches.
int dlclose(void* handle) {
    (void)handle;
    return 0;
}
