//! The derive macro of `base::hashed::Hashed`.

use proc_macro2::TokenStream;
use quote::{format_ident, quote};
use syn::{Data, DeriveInput, Error, Field, Fields, Result, parse_macro_input, parse_quote};

/// Implements `base::hashed::Hashed`: the hash covers each field in its order, except those with
/// `#[hashed(skip)]`, and of an enum the number of the variant first.
#[proc_macro_derive(Hashed, attributes(hashed))]
pub fn hashed(input: proc_macro::TokenStream) -> proc_macro::TokenStream {
    let input = parse_macro_input!(input as DeriveInput);
    implementation(input)
        .unwrap_or_else(Error::into_compile_error)
        .into()
}

fn implementation(mut input: DeriveInput) -> Result<TokenStream> {
    for parameter in input.generics.type_params_mut() {
        parameter.bounds.push(parse_quote!(::base::hashed::Hashed));
    }
    let arms = arms(&input.data)?;
    let name = &input.ident;
    let (parameters, arguments, bounds) = input.generics.split_for_impl();
    Ok(quote! {
        impl #parameters ::base::hashed::Hashed for #name #arguments #bounds {
            #[inline]
            fn add_to(&self, hash: &mut ::base::hash::Hash) {
                match self { #arms }
            }
        }
    })
}

/// The arms of a `match` over the value.
fn arms(data: &Data) -> Result<TokenStream> {
    match data {
        Data::Struct(data) => arm(&quote!(Self), &data.fields, &TokenStream::new()),
        Data::Enum(data) => {
            let variants = (0_u64..).zip(&data.variants).map(|(number, variant)| {
                let name = &variant.ident;
                arm(
                    &quote!(Self::#name),
                    &variant.fields,
                    &quote!(hash.add(#number);),
                )
            });
            variants.collect()
        }
        Data::Union(data) => Err(Error::new_spanned(data.union_token, "must not be a union")),
    }
}

/// The arm of a struct or variant, which begins by `first`.
fn arm(path: &TokenStream, fields: &Fields, first: &TokenStream) -> Result<TokenStream> {
    let (mut patterns, mut added) = (Vec::new(), Vec::new());
    for (member, (number, field)) in fields.members().zip(fields.iter().enumerate()) {
        let name = format_ident!("field_{number}");
        if is_skipped(field)? {
            patterns.push(quote!(#member: _));
        } else {
            patterns.push(quote!(#member: #name));
            added.push(quote!(::base::hashed::Hashed::add_to(#name, hash);));
        }
    }
    Ok(quote!(#path { #(#patterns),* } => { #first #(#added)* }))
}

fn is_skipped(field: &Field) -> Result<bool> {
    let mut is_skipped = false;
    let attributes = field.attrs.iter();
    for attribute in attributes.filter(|each| each.path().is_ident("hashed")) {
        attribute.parse_nested_meta(|meta| {
            is_skipped = meta.path.is_ident("skip");
            let refused = || Err(meta.error("must be `skip`"));
            if is_skipped { Ok(()) } else { refused() }
        })?;
    }
    Ok(is_skipped)
}
