// commands.h — what each command does
// What       each returns the exit code 0 (done) or 1 (worked, with a negative outcome) and throws
//            arris::Error otherwise
#pragma once

namespace arris::program {

class Arguments;

int run_render(const Arguments& arguments);
int run_view(const Arguments& arguments);
int run_info(const Arguments& arguments);
int run_shoot(const Arguments& arguments);
int run_merge(const Arguments& arguments);
int run_compare(const Arguments& arguments);

}  // namespace arris::program
