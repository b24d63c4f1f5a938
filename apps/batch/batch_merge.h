#pragma once
#include "command_line/commands.h"

namespace orchard::apps {

// Runs `orchard batch merge FOLDER.. -o PLACE`. It writes batch.jsonl, batch.csv and batch-summary.json, which depend
// only on the rows, and batch-costs.csv and batch.svg, which contain times. Throws InputError if shards are missing.
void merge_batches(const BatchCommand& command);

}  // namespace orchard::apps
