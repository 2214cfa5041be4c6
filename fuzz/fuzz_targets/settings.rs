//! Settings, scenarios and cards of networks, as text.

#![no_main]

use libfuzzer_sys::fuzz_target;
use ralf::config::Config;
use ralf_depth::Card;
use ralf_sim::Scenario;
use std::path::Path;

fuzz_target!(|text: &str| {
    if let Ok(config) = Config::from_toml(text, &[]) {
        let again = Config::from_toml(&config.to_toml().unwrap(), &[]);
        assert_eq!(again.as_ref(), Ok(&config));
    }
    let _ = Scenario::from_toml(text);
    let _ = Card::parse(Path::new("net.toml"), text);
});
