//! Light sources: each can be hit, sampled and made to emit
