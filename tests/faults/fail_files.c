// A library for LD_PRELOAD: counts the operations by which a program changes files, and lets one of them go wrong.
//
//   FAULT_PROGRAM  the program that is meant; its children are left alone
//   FAULT_COUNT    a file that gets how many operations there were
//   FAULT_AT       which one goes wrong, from 1
//   FAULT_KIND     "fail": it fails as on a full disk; "kill": the program is killed before it
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static atomic_long count;
static long at;
static int kills, meant;

__attribute__((constructor)) static void begin(void) {
  const char* program = getenv("FAULT_PROGRAM");
  const char* which = getenv("FAULT_AT");
  const char* kind = getenv("FAULT_KIND");
  char self[4096] = "";  // not the name that it was called by: flaneur gives its own to what it starts
  const ssize_t size = readlink("/proc/self/exe", self, sizeof self - 1);
  const char* name = size > 0 ? strrchr(self, '/') : NULL;
  meant = program != NULL && name != NULL && strcmp(name + 1, program) == 0;
  at = which == NULL ? 0 : atol(which);
  kills = kind != NULL && strcmp(kind, "kill") == 0;
}

__attribute__((destructor)) static void end(void) {
  const char* path = getenv("FAULT_COUNT");
  if (!meant || path == NULL) return;
  meant = 0;
  FILE* file = fopen(path, "w");
  if (file == NULL) return;
  fprintf(file, "%ld\n", atomic_load(&count));
  fclose(file);
}

// Whether the operation that is about to happen is the one that goes wrong.
static int fails(void) {
  if (!meant || atomic_fetch_add(&count, 1) + 1 != at) return 0;
  if (kills) kill(getpid(), SIGKILL);
  errno = ENOSPC;
  return 1;
}

static void* next(const char* name) { return dlsym(RTLD_NEXT, name); }

#define PASS_ON(type, name, parameters, arguments) \
  type name parameters {                           \
    type(*real) parameters = next(#name);          \
    if (fails()) return -1;                        \
    return real arguments;                         \
  }

PASS_ON(int, rename, (const char* from, const char* to), (from, to))
PASS_ON(int, link, (const char* from, const char* to), (from, to))
PASS_ON(int, linkat, (int a, const char* from, int b, const char* to, int flags), (a, from, b, to, flags))
PASS_ON(int, symlink, (const char* to, const char* path), (to, path))
PASS_ON(int, unlink, (const char* path), (path))
PASS_ON(int, unlinkat, (int folder, const char* path, int flags), (folder, path, flags))
PASS_ON(int, rmdir, (const char* path), (path))
PASS_ON(int, mkdir, (const char* path, mode_t mode), (path, mode))
PASS_ON(int, fsync, (int file), (file))

static int is_regular(int file) {
  struct stat is;
  return fstat(file, &is) == 0 && S_ISREG(is.st_mode);
}

ssize_t write(int file, const void* data, size_t size) {
  ssize_t (*real)(int, const void*, size_t) = next("write");
  if (is_regular(file) && fails()) return -1;
  return real(file, data, size);
}

char* mkdtemp(char* name) {
  char* (*real)(char*) = next("mkdtemp");
  return fails() ? NULL : real(name);
}

static int opens_to_write(int flags) { return (flags & (O_WRONLY | O_RDWR)) != 0; }

int open(const char* path, int flags, ...) {
  int (*real)(const char*, int, ...) = next("open");
  va_list more;
  va_start(more, flags);
  const mode_t mode = va_arg(more, mode_t);
  va_end(more);
  if (opens_to_write(flags) && strncmp(path, "/dev/", 5) != 0 && fails()) return -1;
  return real(path, flags, mode);
}
