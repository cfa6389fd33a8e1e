// A shared object that is no plugin at all.
extern "C" int Answer() { return 42; }
