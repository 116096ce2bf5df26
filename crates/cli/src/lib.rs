//! Etalon: a spectral renderer whose estimators are held to account by statistics
